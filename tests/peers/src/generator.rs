//! Who made the PTX: a folder each, made by `build.sh`.

use optix_device_rs::host::PipelineDescription;
use optix_device_rs::pipeline::Pipeline;
use std::io;
use std::path::{Path, PathBuf};

/// A folder of PTX, named after what made it; `nvcc` has a text for each load, the others one for each shader crate.
#[derive(Clone, Debug)]
pub struct Generator {
    /// `nvcc`, `rustc`, ..; ends with `-exact` where products and sums are not contracted.
    pub name: String,
    folder: PathBuf,
}

/// The generators whose folders are in `folder`, by name.
pub fn generators(folder: &Path) -> io::Result<Vec<Generator>> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            found.push(Generator { name: entry.file_name().to_string_lossy().into_owned(), folder: entry.path() });
        }
    }
    found.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(found)
}

impl Generator {
    /// The PTX of load `name`, whose Rust programs are in `shaders` and whose pipeline is `P`.
    pub fn ptx<P: Pipeline>(&self, name: &str, shaders: &str) -> io::Result<String> {
        let peer = self.name.starts_with("nvcc");
        let path = self.folder.join(format!("{}.ptx", if peer { name } else { shaders }));
        let text = std::fs::read_to_string(&path)
            .map_err(|why| io::Error::new(why.kind(), format!("{}: {why}", path.display())))?;
        Ok(if peer { adopt(&text, &P::DESCRIPTION) } else { text })
    }
}

/// A peer's PTX under the names that the host looks for: entries end with a hash there, and the launch parameters have a
/// symbol of their own, and the pipeline its table of layouts.
fn adopt(text: &str, of: &PipelineDescription) -> String {
    let symbol = of.params.symbol;
    let mut text = text.replace("[params", &format!("[{symbol}")).replace(" params[", &format!(" {symbol}["));
    for entry in entries(of) {
        let Some((plain, _hash)) = entry.rsplit_once('_') else { continue };
        text = text.replace(&format!("{plain}("), &format!("{entry}("));
    }
    let numbers = of.crossings.iter().flat_map(|crossing| [crossing.size as u64, crossing.layout.get()]);
    let numbers: Vec<_> = numbers.map(|number| number.to_string()).collect();
    let (layouts, count) = (of.layouts, numbers.len());
    text + &format!("\n.visible .global .align 8 .b64 {layouts}[{count}] = {{{}}};\n", numbers.join(", "))
}

fn entries(of: &PipelineDescription) -> impl Iterator<Item = &'static str> {
    let raygen = of.raygen.iter().map(|p| p.entry);
    let miss = of.rays.iter().filter_map(|ray| ray.miss.map(|p| p.entry));
    let hit = of.hitgroups.iter().flat_map(|group| group.rays);
    let hit = hit.flat_map(|programs| [programs.closesthit, programs.anyhit, programs.intersection]);
    raygen.chain(miss).chain(hit.flatten()).map(|entry| entry.name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use peer_shaders::occlusion::Occlusion;

    #[test]
    fn peers_get_the_names_that_the_host_looks_for() {
        let text = ".visible .const .align 8 .b8 params[80];\n.visible .entry __raygen__Occlusion_camera()\n{\n\
                    ld.const.u64 %rd8, [params+8];\n}\n";
        let of = Occlusion::DESCRIPTION;
        let adopted = adopt(text, &of);
        assert!(adopted.contains(&format!("{}()", of.raygen[0].entry.name)), "{adopted}");
        assert!(adopted.contains(&format!("[{}+8]", of.params.symbol)), "{adopted}");
        assert!(adopted.contains(&format!(".b8 {}[80]", of.params.symbol)), "{adopted}");
    }
}
