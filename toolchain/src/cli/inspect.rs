//! `cargo optix inspect`

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use optix_toolchain::inspect::ptxas::{Ptxas, Usage};
use optix_toolchain::inspect::{Class, Program, pairs, programs, with_source};
use optix_toolchain::json::Json;

use super::options::{Crate, Options};
use super::{Failure, Outcome};

#[derive(clap::Args)]
pub(super) struct How {
    /// A GPU architecture for registers and spills. May be repeated; the PTX is compiled for the oldest.
    #[arg(long, value_name = "sm_XX", default_values_t = [optix_toolchain::DEFAULT_ARCH.to_string()])]
    arch: Vec<String>,
    #[command(flatten)]
    build: Options,
    /// A PTX file to look at, such as nvcc's, instead of compiling a crate.
    #[arg(long, value_name = "FILE", conflicts_with = "path")]
    ptx: Option<PathBuf>,
    /// The PTX file of another build, to be put beside this one, program by program.
    #[arg(long, value_name = "FILE")]
    compare: Option<PathBuf>,
    /// How to print.
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
    /// Print instructions below the source lines that they come from, of programs whose names contain this.
    #[arg(long, value_name = "PROGRAM", num_args = 0..=1, default_missing_value = "", conflicts_with = "compare")]
    source: Option<String>,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// For people.
    Table,
    /// One object a module, each on a line.
    Json,
}

pub(super) fn run(how: &How) -> Outcome {
    // sm_90 before sm_100
    let oldest = how.arch.iter().min_by_key(|arch| (arch.len(), arch.as_str()));
    let oldest = oldest.map_or(optix_toolchain::DEFAULT_ARCH, String::as_str);
    let (modules, area) = modules(how, oldest)?;
    let ptxas = Ptxas::find();
    if ptxas.is_none() {
        eprintln!("note: no ptxas, so no registers; {}", Ptxas::MISSING);
    }
    let measure = |name: &str, text: &str| Measured::new(name, text, &how.arch, ptxas.as_ref(), &area);
    let other = how.compare.as_ref().map(|path| Ok::<_, Failure>(measure(&path.to_string_lossy(), &read(path)?)));
    let other = other.transpose()?;
    for (name, text) in &modules {
        if let Some(part) = &how.source {
            let source = with_source(text, |program| program.contains(part.as_str()));
            say!("{}", source.ok_or_else(|| Failure(format!("{name} has no line information; compile it with it")))?);
            continue;
        }
        let measured = measure(name, text);
        match (how.format, &other) {
            (Format::Json, other) => say!("{}", json(&measured, other.as_ref())),
            (Format::Table, None) => table(&measured),
            (Format::Table, Some(other)) => comparison(&measured, other),
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// The PTX texts to look at, by name, and the folder for intermediate files.
fn modules(how: &How, arch: &str) -> Result<(Vec<(String, String)>, PathBuf), Failure> {
    if let Some(path) = &how.ptx {
        return Ok((vec![(path.display().to_string(), read(path)?)], std::env::temp_dir()));
    }
    let (crates, area) = how.build.crates()?;
    let compile = |one: &Crate| {
        let mut shaders = how.build.shaders(one, arch);
        if how.source.is_some() {
            shaders = shaders.line_info(true);
        }
        let built = shaders.compile_in(&area)?;
        Ok((built.name, built.text))
    };
    let modules = crates.iter().map(compile).collect::<Result<_, Failure>>()?;
    Ok((modules, area))
}

fn read(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path).map_err(|e| Failure(format!("cannot read {}: {e}", path.display())))
}

/// The figures of a program, in the order in which reports show them.
type Figures = Vec<(String, usize)>;

/// A module with everything that was measured of its programs.
struct Measured {
    name: String,
    programs: Vec<Program>,
    /// What `ptxas` says, by architecture.
    usages: Vec<(String, Vec<Usage>)>,
}

impl Measured {
    fn new(name: &str, text: &str, archs: &[String], ptxas: Option<&Ptxas>, area: &Path) -> Self {
        let mut usages = Vec::new();
        for (arch, ptxas) in archs.iter().filter_map(|arch| Some((arch, ptxas?))) {
            match ptxas.usage(text, arch, area) {
                Ok(usage) => usages.push((arch.clone(), usage)),
                Err(error) => eprintln!("note: no registers of {name} for {arch}: {error}"),
            }
        }
        Self { name: name.to_string(), programs: programs(text), usages }
    }

    fn figures(&self, program: &Program) -> Figures {
        let mut figures =
            vec![("bytes".to_string(), program.size), ("instructions".to_string(), program.instructions())];
        figures.extend(Class::ALL.map(|class| (class.name().to_string(), program.count(class))));
        let Program { parameters, record, .. } = program;
        figures.extend(
            [
                ("parameter loads", parameters.count),
                ("parameter bytes", parameters.bytes),
                ("record loads", record.count),
                ("record bytes", record.bytes),
                ("local memory", program.local_memory),
            ]
            .map(|(name, figure)| (name.to_string(), figure)),
        );
        for (arch, usages) in &self.usages {
            let Some(usage) = usages.iter().find(|usage| usage.program == program.name) else { continue };
            figures.extend(usage.registers.map(|registers| (format!("{arch} registers"), registers)));
            figures.push((format!("{arch} stack"), usage.stack));
            figures.push((format!("{arch} spills"), usage.spill_stores + usage.spill_loads));
        }
        figures
    }
}

/// Prints a line of figures for each program, without columns that are zero everywhere, and then which functions each
/// program calls.
fn table(measured: &Measured) {
    let rows: Vec<Figures> = measured.programs.iter().map(|program| measured.figures(program)).collect();
    let figure =
        |row: &Figures, name: &str| row.iter().find(|(other, _)| other == name).map_or(0, |(_, figure)| *figure);
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in rows.iter().flatten().filter(|(_, figure)| *figure > 0) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let order = |name: &&str| rows.iter().find_map(|row| row.iter().position(|(other, _)| other == name));
    names.sort_by_key(order);
    // A column's name of two words takes two lines of the head.
    let heads: Vec<(&str, &str)> = names.iter().map(|name| name.split_once(' ').unwrap_or(("", name))).collect();
    let line = |cells: Vec<String>, last: &str| {
        let cells = cells.iter().zip(&heads).map(|(cell, (a, b))| format!("{cell:>0$}", a.len().max(b.len()).max(6)));
        say!("{}  {last}", cells.collect::<Vec<_>>().join(" "));
    };
    say!("{}", measured.name);
    line(heads.iter().map(|(head, _)| head.to_string()).collect(), "");
    line(heads.iter().map(|(_, head)| head.to_string()).collect(), "program");
    for (row, program) in rows.iter().zip(&measured.programs) {
        let name = if program.is_entry { program.name.clone() } else { format!("{} (called)", program.name) };
        line(names.iter().map(|name| figure(row, name).to_string()).collect(), &name);
    }
    for program in measured.programs.iter().filter(|program| !program.calls.is_empty()) {
        let calls = program.calls.iter();
        let calls = calls.map(|(name, &count)| if count > 1 { format!("{name} x{count}") } else { name.clone() });
        say!("{} calls {}", program.name, calls.collect::<Vec<_>>().join(", "));
    }
    say!("");
}

/// Prints each program's figures in two builds, and their ratio.
fn comparison(measured: &Measured, other: &Measured) {
    say!("{} : {}", measured.name, other.name);
    for (ours, theirs) in pairs(&measured.programs, &other.programs) {
        let name = |program: Option<&Program>| program.map_or("-".to_string(), |program| program.name.clone());
        say!("  {} : {}", name(ours), name(theirs));
        let (Some(ours), Some(theirs)) = (ours, theirs) else { continue };
        for (figure, a, b) in side_by_side(&measured.figures(ours), &other.figures(theirs)) {
            let ratio = if b > 0 { format!("{:8.3}", a as f64 / b as f64) } else { String::new() };
            say!("    {figure:<20}{a:>8}{b:>8}{ratio}");
        }
    }
}

/// The figures that two programs have, except those that are zero in both.
fn side_by_side(ours: &Figures, theirs: &Figures) -> Vec<(String, usize, usize)> {
    let other = |name: &str| theirs.iter().find(|(other, _)| other == name).map(|(_, figure)| *figure);
    let both = ours.iter().filter_map(|(name, figure)| Some((name.clone(), *figure, other(name)?)));
    both.filter(|(_, a, b)| a + b > 0).collect()
}

/// `{"module":"x","programs":[{"name":..,"entry":..,"figures":{..},"calls":{..},"other":{..}}]}`
fn json(measured: &Measured, other: Option<&Measured>) -> Json {
    let none = Vec::new();
    let programs = pairs(&measured.programs, other.map_or(&none, |other| &other.programs)).into_iter();
    let one = |of: &Measured, program: &Program| {
        let counts = |counts: Figures| Json::object(counts.into_iter().map(|(key, n)| (key, Json::Number(n as f64))));
        vec![
            ("name", Json::String(program.name.clone())),
            ("entry", Json::Bool(program.is_entry)),
            ("figures", counts(of.figures(program))),
            ("calls", counts(program.calls.clone().into_iter().collect())),
        ]
    };
    let programs = programs.map(|(ours, theirs)| {
        let mut members = ours.map(|program| one(measured, program)).unwrap_or_default();
        members.extend(other.zip(theirs).map(|(other, program)| ("other", Json::object(one(other, program)))));
        Json::object(members)
    });
    let programs = Json::Array(programs.collect());
    let mut members = vec![("module", Json::String(measured.name.clone())), ("programs", programs)];
    members.extend(other.map(|other| ("compared", Json::String(other.name.clone()))));
    Json::object(members)
}
