//! What `rustc` says while cargo compiles for the device.

use std::fmt;
use std::io::{BufRead, BufReader, IsTerminal};
use std::process::{Command, Stdio};

use crate::error::{Doing, Error};
use crate::json::Json;
use crate::metadata::{Package, Workspace};

/// Cargo's option for what [`run`] reads.
pub(crate) fn format() -> &'static str {
    if std::io::stderr().is_terminal() {
        "--message-format=json-diagnostic-rendered-ansi"
    } else {
        "--message-format=json"
    }
}

/// Runs a cargo that prints its messages in our [`format`], and shows them as they come. A crate that needs the standard
/// library becomes an error that names it; `graph` has the packages of the shader crate `from`.
pub(crate) fn run(command: &mut Command, doing: &str, graph: &Workspace, from: &Package) -> Result<(), Error> {
    let program = command.get_program().to_string_lossy().into_owned();
    let mut cargo = command.stdout(Stdio::piped()).spawn().doing(|| format!("cannot run {program}"))?;
    let (mut without_std, mut has_error) = (Vec::<String>::new(), false);
    let mut of_std = None;
    for line in cargo.stdout.take().into_iter().flat_map(|out| BufReader::new(out).lines()).map_while(Result::ok) {
        // Lines that are not JSON were printed by a build script or a proc macro.
        let Ok(json) = Json::parse(&line) else { continue };
        let (message, package) = (json.get("message"), json.get("package_id").str().unwrap_or_default());
        has_error |= message.get("level").str() == Some("error");
        if message.get("message").str() == Some("can't find crate for `std`") {
            without_std.push(package.to_string());
        }
        if package == from.id && of_std.is_none() {
            of_std = message.get("message").str().and_then(OfStd::missing);
        }
        // Whatever else the compiler says of a crate that lacks the standard library only follows from that.
        if let Some(text) = message.get("rendered").str().filter(|_| !without_std.iter().any(|id| id == package)) {
            eprint!("{text}");
        }
    }
    let status = cargo.wait().doing(|| format!("cannot run {program}"))?;
    match (without_std.first(), of_std) {
        _ if status.success() => Ok(()),
        (Some(id), _) => Err(Error::NeedsStd(NeedsStd::new(graph, from, id))),
        (None, Some(of_std)) => Err(Error::OfStd { package: from.name.clone(), of_std }),
        (None, None) if has_error => Err(Error::Step { doing: doing.to_string(), status }),
        (None, None) => Err(Error::Aborted { doing: doing.to_string(), status }),
    }
}

/// A name of the standard library that a shader crate uses, and what to write instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OfStd {
    /// As it is written: `println!`.
    pub name: &'static str,
    /// What to write.
    pub instead: &'static str,
}

impl OfStd {
    /// Recognised by the compiler's message that such a name can't be found.
    fn missing(message: &str) -> Option<Self> {
        const SHOW: &str = "write numbers to a `SliceMut` of the launch parameters, which the host reads and prints";
        const TEXT: &str = "programs make no text: say a number, or throw a variant of a `UserException`";
        const HEAP: &str = "take an array of a fixed length, or a `SliceMut` whose memory the host allocates";
        const MACROS: [(&str, &str); 7] = [
            ("println!", SHOW),
            ("print!", SHOW),
            ("eprintln!", SHOW),
            ("eprint!", SHOW),
            ("dbg!", SHOW),
            ("format!", TEXT),
            ("vec!", HEAP),
        ];
        const TYPES: [(&str, &str); 4] = [("String", TEXT), ("Vec", HEAP), ("Box", HEAP), ("HashMap", HEAP)];
        let (what, name) = message.split_once('`').and_then(|(what, rest)| Some((what, rest.split_once('`')?.0)))?;
        let is_macro = what.starts_with("cannot find macro");
        let is_type =
            ["cannot find type", "cannot find struct", "failed to resolve"].iter().any(|m| what.starts_with(m));
        let of = |(of, _): &&(&str, &str)| match of.strip_suffix('!') {
            Some(of) => is_macro && of == name,
            None => is_type && *of == name,
        };
        MACROS.iter().chain(&TYPES).find(of).map(|&(name, instead)| Self { name, instead })
    }
}

/// A crate that can't be compiled for the device because it needs the standard library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NeedsStd {
    /// Its name and version: `rayon 1.11.0`.
    pub package: String,
    /// The names of the packages from the shader crate to this one, both included.
    pub way: Vec<String>,
    /// The feature of it that asks for the standard library, where one does.
    pub feature: Option<String>,
}

impl NeedsStd {
    fn new(graph: &Workspace, from: &Package, id: &str) -> Self {
        const STD: [&str; 2] = ["std", "use_std"];
        let is_to = |way: &Vec<&Package>| way.last().is_some_and(|last| last.id == id);
        let way = graph.ways(from).into_iter().find(is_to).unwrap_or_default();
        let package = way.last();
        let feature = package.and_then(|package| package.enabled.iter().find(|on| STD.contains(&on.as_str())));
        Self {
            package: package.map_or_else(|| id.to_string(), |package| format!("{} {}", package.name, package.version)),
            feature: feature.cloned(),
            way: way.iter().map(|package| package.name.clone()).collect(),
        }
    }
}

impl NeedsStd {
    /// What is wrong.
    pub fn problem(&self) -> String {
        let feature = self.feature.as_ref().map_or(String::new(), |feature| format!(", for its feature `{feature}`"));
        let way = if self.way.len() > 2 { format!(" ({})", self.way.join(" uses ")) } else { String::new() };
        format!("`{}` needs the standard library, which the device does not have{feature}{way}", self.package)
    }

    /// What to do about it.
    pub fn remedy(&self) -> String {
        match &self.way[..] {
            [_, dependency, ..] => format!(
                "take `{dependency}` with `default-features = false`, or another crate, or use it on the host only: \
                 `[target.'cfg(not(target_arch = \"nvptx64\"))'.dependencies]`"
            ),
            _ => "put `#![no_std]` at the top of its src/lib.rs, and take from `core` what it takes from `std`".into(),
        }
    }
}

impl fmt::Display for NeedsStd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.problem(), self.remedy())
    }
}

#[cfg(test)]
mod tests {
    use super::OfStd;

    #[test]
    fn what_is_of_the_standard_library_is_known_by_its_message() {
        let name = |message| OfStd::missing(message).map(|of_std| of_std.name);
        for (message, of) in [
            ("cannot find macro `println` in this scope", "println!"),
            ("cannot find macro `vec` in this scope", "vec!"),
            ("cannot find type `String` in this scope", "String"),
            ("failed to resolve: use of undeclared type `Vec`", "Vec"),
        ] {
            assert_eq!(name(message), Some(of), "{message}");
        }
        for message in
            ["cannot find type `println` in this scope", "cannot find macro `Vec` in this scope", "`Vec`", ""]
        {
            assert_eq!(name(message), None, "{message}");
        }
    }
}
