//! `cargo optix verify`

use std::path::Path;
use std::process::ExitCode;

use optix_toolchain::json::Json;
use optix_toolchain::verify::{Finding, Level, Rule, Verified};

use super::Outcome;
use super::options::Options;

/// How to verify.
pub(super) struct How {
    pub arch: String,
    pub options: Options,
    pub allowed: Vec<String>,
    pub json: bool,
}

pub(super) fn run(how: &How) -> Outcome {
    let (crates, area) = how.options.crates()?;
    let mut errors = 0;
    for one in &crates {
        let shaders = how.options.shaders(one, &how.arch).quiet(how.json);
        let verified = shaders.verify_in(&area, &how.allowed)?;
        if how.json {
            verified.findings.iter().for_each(|finding| say!("{}", json(&verified.built.name, finding)));
        } else {
            report(&one.path, &verified);
        }
        errors += verified.findings.iter().filter(|finding| finding.level == Level::Error).count();
    }
    Ok(if errors == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn report(path: &Path, verified: &Verified) {
    let mut explained: Vec<Rule> = Vec::new();
    for finding in &verified.findings {
        say!("{finding}");
        if !explained.contains(&finding.rule) {
            explained.push(finding.rule);
            say!("    help: {}", finding.rule.help());
        }
    }
    let pipelines: Vec<String> = verified
        .pipelines
        .iter()
        .map(|pipeline| format!("`{}` with {} programs", pipeline.name, pipeline.programs.len()))
        .collect();
    let pipelines = if pipelines.is_empty() { "no pipelines".to_string() } else { pipelines.join(", ") };
    let found = match verified.findings.len() {
        0 => "nothing found".to_string(),
        1 => "1 finding".to_string(),
        count => format!("{count} findings"),
    };
    say!("{}: {pipelines}: {found}", path.display());
}

/// One object on one line.
fn json(of: &str, finding: &Finding) -> String {
    let level = match finding.level {
        Level::Error => "error",
        Level::Warning => "warning",
    };
    let members = [
        ("crate", of),
        ("level", level),
        ("rule", finding.rule.name()),
        ("item", &finding.item),
        ("message", &finding.message),
    ];
    Json::object(members.map(|(key, text)| (key, Json::String(text.to_string())))).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_can_be_read_back() {
        let finding = Finding {
            level: Level::Error,
            rule: Rule::Trace,
            item: "miss program `a\"b`".into(),
            message: "line\nbreak \\".into(),
        };
        let read = optix_toolchain::json::Json::parse(&json("x", &finding)).expect("valid JSON");
        assert_eq!(read.get("item").str(), Some("miss program `a\"b`"));
        assert_eq!(read.get("message").str(), Some("line\nbreak \\"));
        assert_eq!(read.get("rule").str(), Some("trace"));
    }
}
