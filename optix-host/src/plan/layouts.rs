//! Compares the layouts in the PTX with those of this host, which agree if both come from the same source.

use crate::error::{LayoutDifference, PipelineError};
use crate::{Error, Result};
use optix_device_rs::host::PipelineDescription;
use optix_device_rs::layout::Crossing;
use optix_ptx::Module;

/// Checks that everything that crosses between host and device is laid out in the PTX as on this host.
pub(super) fn check_layouts(description: &PipelineDescription, module: &Module<'_>) -> Result<()> {
    let here = description.crossings;
    let there = module.variables.iter().find(|variable| variable.name == description.layouts);
    let error = match there.map(|variable| variable.numbers()) {
        None => PipelineError::NoLayouts { table: description.layouts },
        Some(numbers) if numbers.len() != 2 * here.len() => {
            PipelineError::CrossingCount { ptx: numbers.len() / 2, host: here.len() }
        }
        Some(numbers) => {
            let (there, _) = numbers.as_chunks();
            let pairs = here.iter().zip(there);
            let different: Vec<_> = pairs.filter_map(|(here, there)| difference(here, *there)).collect();
            if different.is_empty() {
                return Ok(());
            }
            PipelineError::Layouts(different)
        }
    };
    Err(Error::Pipeline { pipeline: description.name, error })
}

/// How a type differs from the same type in the PTX, whose table has its size and layout. `None` if it does not differ.
fn difference(here: &Crossing, [ptx, layout_there]: [u64; 2]) -> Option<LayoutDifference> {
    let Crossing { what, name, size, layout } = *here;
    let host = size as u64;
    let same = ptx == host && layout_there == layout.get();
    (!same).then(|| LayoutDifference { what, name, ptx, host, unit: here.unit() })
}

#[cfg(test)]
mod tests {
    use super::super::tests::{EMPTY, PTX};
    use super::*;
    use optix_device_rs::layout::Layout;

    #[test]
    fn layouts_are_compared_type_by_type() {
        let record = |name, size, ty| Crossing::new("record", name, size, Layout::of(ty));
        const HERE: [Crossing; 2] = [
            Crossing::new("launch parameters", "Frame", 32, Layout::of("f")),
            Crossing::new("attributes", "Hit", 3, Layout::of("h")),
        ];
        let description = PipelineDescription { crossings: &HERE, layouts: "layouts", ..EMPTY };
        let with = |there: &[Crossing]| {
            let numbers = there.iter().flat_map(|crossing| [crossing.size as i64, crossing.layout.get() as i64]);
            let numbers: Vec<_> = numbers.map(|number| number.to_string()).collect();
            let text =
                format!("{PTX}.visible .global .align 8 .b64 layouts[{}] = {{{}}};", numbers.len(), numbers.join(", "));
            check_layouts(&description, &Module::read(&text)).err().map(|error| error.to_string())
        };
        assert_eq!(with(&HERE), None);
        let says = |there: &[Crossing], parts: &[&str]| {
            let error = with(there).expect("another layout");
            assert!(parts.iter().all(|part| error.contains(part)), "{error}");
        };
        let [frame, hit] = HERE;
        says(&[frame, Crossing { size: 7, ..hit }], &["pipeline Test", "attributes `Hit`: 7 words there, 3 here"]);
        let other = Crossing { layout: Layout::of("g"), ..frame };
        says(&[other, hit], &["launch parameters `Frame`: 32 bytes in both, but with other fields"]);
        says(
            &[record("R", 4, "r"), record("S", 4, "r")],
            &["`Frame`: 4 bytes there, 32 here; attributes `Hit`: 4 words"],
        );
        says(&[frame], &["1 types cross between host and device there, and 2 here"]);
        let error = check_layouts(&description, &Module::read(PTX)).expect_err("no layouts").to_string();
        assert!(error.contains("does not have the pipeline's layouts, `layouts`"), "{error}");
    }
}
