//! `cargo optix verify`

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use optix_toolchain::Shaders;
use optix_toolchain::verify::{Finding, Level, Rule, Verified};

use super::{Outcome, build};

/// How to verify.
pub(super) struct Options {
    pub arch: String,
    pub allowed: Vec<String>,
    pub json: bool,
}

pub(super) fn run(options: &Options, path: Option<PathBuf>) -> Outcome {
    let (crates, area) = build::crates(path)?;
    let mut errors = 0;
    for path in &crates {
        let shaders = Shaders::new(path).arch(&options.arch).quiet(options.json);
        let verified = shaders.verify_in(&area, &options.allowed)?;
        if options.json {
            verified.findings.iter().for_each(|finding| say!("{}", json(&verified.built.name, finding)));
        } else {
            report(path, &verified);
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
    let [of, item, message] = [of, &finding.item, &finding.message].map(string);
    format!(r#"{{"crate":{of},"level":"{level}","rule":"{}","item":{item},"message":{message}}}"#, finding.rule.name())
}

fn string(text: &str) -> String {
    let mut string = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => string.extend(['\\', c]),
            c if c.is_control() => string.push_str(&format!("\\u{:04x}", c as u32)),
            c => string.push(c),
        }
    }
    string.push('"');
    string
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
