//! What each construct becomes: that libNVVM and ptxas accept it, and that it computes the same.
//!
//! Where there is no libNVVM (`cargo optix setup --nvvm`, or `OPTIX_NVVM`), the tests that need one say so.

mod accepted;
mod computed;
mod fuzz;
mod ir_of;
mod lines;
mod refused;
mod whole;

use optix_nvvm::{Dialect, Library, libdevice, translate};
use optix_toolchain::nvvm::choose;

/// Every architecture that is compiled for in tests: of all generations that take LLVM 7's IR, and two that take modern IR.
const ARCHS: [&str; 7] = ["75", "80", "86", "89", "90", "100", "120"];

/// libNVVM, where it is there; otherwise says that the test did not run.
fn library(test: &str) -> Option<Library> {
    match choose() {
        Ok(library) => Some(library),
        Err(reason) => {
            eprintln!("{test}: not run, no libNVVM: {reason}");
            None
        }
    }
}

/// Translates and compiles IR for an architecture; fails the test if that does not work.
fn compile(library: &Library, ir: &str, arch: &str) -> String {
    let dialect = Dialect::of(&format!("sm_{arch}")).expect("an architecture");
    let module = translate(ir, dialect).unwrap_or_else(|refusal| panic!("{refusal}\n{ir}"));
    let libdevice = libdevice(&library.path).and_then(|path| std::fs::read(path).ok());
    let libdevice = libdevice.as_deref().filter(|_| module.needs_libdevice);
    let options = [format!("-arch=compute_{arch}")];
    library.compile(&module, libdevice, &options).unwrap_or_else(|failure| panic!("{failure}\n{}", module.text))
}
