//! What the driver's compiler says of bound values (guide 6.5.1).

use crate::pipeline::BoundValue;

/// How the driver reports a load that it replaced; behind it come offset and size of the bound value, offset of the load, and
/// the annotation, which is the field's name.
const REPLACED: &str = "Found specialization";

/// For each bound value a line on how many of its loads became constants; `log` is what compiling the module wrote.
pub(super) fn bound_values(log: &str, bound: &[BoundValue]) -> Vec<String> {
    let line = |value: &BoundValue| {
        let name = value.field.name;
        // At log level 4 there is always feedback on a module that was compiled.
        if log.is_empty() {
            return format!(
                "bound value {name}: the module came from the driver's cache, so nothing is said of its loads"
            );
        }
        match log.lines().filter(|line| is_of(line, value)).count() {
            0 => format!("bound value {name}: the driver found no load of it that it can replace"),
            1 => format!("bound value {name}: 1 load became a constant"),
            loads => format!("bound value {name}: {loads} loads became constants"),
        }
    };
    bound.iter().map(line).collect()
}

/// Whether the line reports a load of this value: it has the name, or offset and size.
fn is_of(line: &str, value: &BoundValue) -> bool {
    let Some((_, what)) = line.split_once(REPLACED) else { return false };
    let mut words = what.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty());
    if words.any(|word| word == value.field.name) {
        return true;
    }
    let place = format!("offset {}, size {},", value.field.offset, value.field.size);
    what.contains(&place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use optix_device_rs::params::Field;

    #[test]
    fn replaced_loads_are_counted_by_field() {
        let value =
            |name, offset| BoundValue { field: Field { name, offset, size: 4, bound: true }, bytes: vec![0; 4] };
        let bound = [value("depth", 8), value("seed", 12), value("dep", 16)];
        let log = "Info: Found specialization of launch parameters: offset 8, size 4, load offset 8, \"depth\"\n\
                   Info: Found specialization of launch parameters: offset 8, size 4, load offset 8\n\
                   Info: Found specialization of launch parameters: offset 12, size 4, load offset 12\n\
                   Info: Module statistics";
        let lines = bound_values(log, &bound);
        assert_eq!(lines[0], "bound value depth: 2 loads became constants");
        assert_eq!(lines[1], "bound value seed: 1 load became a constant");
        assert!(lines[2].contains("found no load"), "{}", lines[2]);
        assert!(bound_values("", &bound)[0].contains("cache"));
    }
}
