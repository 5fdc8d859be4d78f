//! NVIDIA's libNVVM as a code generator, loaded at run time.
//!
//! libNVVM takes LLVM IR as text. For architectures before `sm_100` it reads the IR of LLVM 7, which is older than
//! opaque pointers and much else that `rustc` writes. So the IR is read, lowered and printed again. No LLVM is needed.
//!
//! | step | module |
//! | --- | --- |
//! | text to a model | the crate `optix_llvm_ir` |
//! | what LLVM 7 or libNVVM does not know to what it does | `lower` |
//! | the model to text, in either dialect | `print` |
//! | what can't be translated, and where it is | `refusal` |
//! | find, choose, load and call libNVVM | `find`, `driver`, `library` |

mod driver;
mod find;
mod library;
mod lower;
mod print;
mod refusal;

pub use driver::{NoLibrary, PtxVersion, Rejected, Why, choose};
pub use find::{cached, libdevice, libraries};
pub use library::{Failure, Library};
pub use refusal::Refusal;

/// The LLVM IR that libNVVM reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// For architectures before `sm_100`.
    Llvm7,
    /// For `sm_100` and newer.
    Modern,
}

impl Dialect {
    /// The dialect for an architecture such as `sm_75`. `None` if that is no architecture.
    ///
    /// ```
    /// use optix_nvvm::Dialect;
    /// assert_eq!(Dialect::of("sm_90"), Some(Dialect::Llvm7));
    /// assert_eq!(Dialect::of("sm_100a"), Some(Dialect::Modern));
    /// ```
    pub fn of(arch: &str) -> Option<Self> {
        let digits = arch.strip_prefix("sm_")?.trim_end_matches(|c: char| c.is_ascii_lowercase());
        let number: u32 = digits.parse().ok()?;
        Some(if number < 100 { Self::Llvm7 } else { Self::Modern })
    }
}

/// LLVM IR for libNVVM.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Translated {
    /// The module.
    pub text: String,
    /// Whether it calls functions of libdevice.
    pub needs_libdevice: bool,
}

/// Translates what `rustc --emit=llvm-ir` wrote for the device.
///
/// ```
/// use optix_nvvm::{Dialect, translate};
/// let ir = "define float @negated(float %0) {\n  %2 = fneg float %0\n  ret float %2\n}\n";
/// let translated = translate(ir, Dialect::Llvm7)?;
/// assert!(translated.text.contains("fsub float 0x8000000000000000, %v.0"));
/// # Ok::<(), optix_nvvm::Refusal>(())
/// ```
pub fn translate(ir: &str, dialect: Dialect) -> Result<Translated, Refusal> {
    let read = optix_llvm_ir::module(ir);
    let mut module = read.map_err(|refused| Refusal::of(refused.unknown, ir, refused.line, &refused.function))?;
    let needs_libdevice = lower::module(&mut module, ir)?;
    Ok(Translated { text: print::module(&module, dialect, ir)?, needs_libdevice })
}
