//! What the driver's compiler says of bound values (guide 6.5.1).

use crate::plan::BoundValue;

/// The first words of the driver's report of a load that it replaced. The next lines have the annotation, which is the
/// field's name, and offset and size of the value and of the load.
const REPLACED: &str = "Found specialization";
/// The first word of any report.
const REPORT: &str = "Info:";

/// For each bound value, a line that tells how many of its loads became constants. `log` is what the compiler wrote
/// about the module.
pub(super) fn bound_values(log: &str, bound: &[BoundValue]) -> Vec<String> {
    let line = |value: &BoundValue| {
        let name = value.field.name;
        // At log level 4, the compiler always gives feedback on a module, so an empty log means that the module came
        // from the cache.
        if log.is_empty() {
            return format!(
                "bound value {name}: the module came from the driver's cache, so nothing is said of its loads"
            );
        }
        match log.split(REPORT).filter(|report| is_of(report, value)).count() {
            0 => format!("bound value {name}: the driver found no load of it that it can replace"),
            1 => format!("bound value {name}: 1 load became a constant"),
            loads => format!("bound value {name}: {loads} loads became constants"),
        }
    };
    bound.iter().map(line).collect()
}

/// Whether the report is of this value.
fn is_of(report: &str, value: &BoundValue) -> bool {
    let annotation = |line: &str| {
        let (key, name) = line.split_once(':')?;
        Some(key.trim() == "annotation" && name.trim() == value.field.name)
    };
    report.trim_start().starts_with(REPLACED) && report.lines().any(|line| annotation(line) == Some(true))
}

#[cfg(test)]
mod tests {
    use super::*;
    use optix_device_rs::params::Field;

    #[test]
    fn replaced_loads_are_counted_by_field() {
        let value = |name, offset| BoundValue {
            field: Field { name, offset, size: 4, bound: true, slice: false },
            bytes: vec![0; 4],
        };
        let bound = [value("depth", 8), value("seed", 12), value("dep", 16)];
        let report = |name, offset| {
            format!(
                "Info: Found specialization\n\tNo source location available.\n\tannotation : {name}\n\
                 \toffset     : {offset}\t\tsize       : 4\n\tload offset: {offset}\t\tload size  : 4\n"
            )
        };
        let log =
            [report("depth", 8), report("depth", 8), report("seed", 12), "Info: Module Statistics".into()].concat();
        let lines = bound_values(&log, &bound);
        assert_eq!(lines[0], "bound value depth: 2 loads became constants");
        assert_eq!(lines[1], "bound value seed: 1 load became a constant");
        assert!(lines[2].contains("found no load"), "{}", lines[2]);
        assert!(bound_values("", &bound)[0].contains("cache"));
    }
}
