//! Lines of the source: kept through both dialects, those of inlined functions too.

use optix_nvvm::{Dialect, Library, translate};
use optix_toolchain::nvvm::choose;

use super::accepted::assemble;
use super::{ARCHS, library};

/// As `rustc -Cdebuginfo=line-directives-only` writes it; `scale` was inlined.
const IR: &str = r#"
define ptx_kernel void @__raygen__lit(ptr noundef captures(none) %p) unnamed_addr !dbg !15 {
start:
  %0 = load float, ptr %p, align 4, !dbg !27, !noundef !10
  %1 = tail call nsz float @llvm.maximumnum.f32(float %0, float 2.000000e+00), !dbg !37
  %2 = call i32 @llvm.uadd.sat.i32(i32 5, i32 3), !dbg !27
  %3 = uitofp i32 %2 to float, !dbg !27
  %4 = fmul float %1, %3, !dbg !27
  store float %4, ptr %p, align 4, !dbg !27
  ret void, !dbg !51
}
declare float @llvm.maximumnum.f32(float, float)
declare i32 @llvm.uadd.sat.i32(i32, i32)
!llvm.module.flags = !{!2}
!llvm.dbg.cu = !{!4}
!2 = !{i32 2, !"Debug Info Version", i32 3}
!4 = distinct !DICompileUnit(language: DW_LANG_Rust, file: !5, producer: "clang LLVM (rustc version 1.96.0)", isOptimized: true, runtimeVersion: 0, emissionKind: DebugDirectivesOnly, splitDebugInlining: false, nameTableKind: None)
!5 = !DIFile(filename: "lib.rs/@/lib.1-cgu.0", directory: "/shaders")
!7 = !DIFile(filename: "src/lib.rs", directory: "/shaders", checksumkind: CSK_MD5, checksum: "6b58b2001f8bdb43388ee3cb36df9a0f")
!8 = !DINamespace(name: "shaders", scope: null)
!9 = !DISubroutineType(types: !10)
!10 = !{}
!15 = distinct !DISubprogram(name: "__raygen__lit", scope: !8, file: !7, line: 8, type: !9, scopeLine: 8, flags: DIFlagPrototyped, spFlags: DISPFlagDefinition | DISPFlagOptimized, unit: !4, templateParams: !10)
!17 = distinct !DILexicalBlock(scope: !15, file: !7, line: 9, column: 5)
!27 = !DILocation(line: 12, column: 19, scope: !17)
!37 = !DILocation(line: 30, column: 9, scope: !38, inlinedAt: !42)
!38 = distinct !DISubprogram(name: "scale<(f32, \22x\22)>", linkageName: "_RNvC7shaders5scale", scope: !8, file: !7, line: 29, type: !9, scopeLine: 29, flags: DIFlagPrototyped, spFlags: DISPFlagLocalToUnit | DISPFlagDefinition | DISPFlagOptimized, unit: !4, templateParams: !10)
!42 = distinct !DILocation(line: 13, column: 65, scope: !17)
!51 = !DILocation(line: 15, column: 2, scope: !15)
"#;

fn compile(library: &Library, ir: &str, arch: &str) -> String {
    let module = translate(ir, Dialect::of(&format!("sm_{arch}")).expect("an architecture")).expect("translated");
    let options = [format!("-arch=compute_{arch}"), "-generate-line-info".into()];
    library.compile(&module, None, &options).unwrap_or_else(|failure| panic!("{failure}\n{}", module.text))
}

#[test]
fn lines_are_those_of_the_source() {
    let Some(library) = library("lines_are_those_of_the_source") else { return };
    for arch in ARCHS {
        let ptx = compile(&library, IR, arch);
        let file = ptx.lines().find(|line| line.trim_start().starts_with(".file")).expect("a file");
        assert!(file.contains("/shaders") && file.contains("src/lib.rs"), "{file}");
        let locations: Vec<&str> =
            ptx.lines().filter_map(|line| line.trim().strip_prefix(".loc")).map(str::trim).collect();
        let at = |place: &str| locations.iter().find(|location| location.starts_with(place));
        assert!(at("1 12 19").is_some() && at("1 15 2").is_some(), "{ptx}");
        assert!(
            at("1 30 9").is_some(),
            "the line of what was inlined:
{ptx}"
        );
        assemble(&ptx, arch);
    }
}

#[test]
fn what_is_not_as_rustc_writes_it_has_no_line() {
    // A scope that is nowhere, one that is its own, and a kind that no instruction has.
    for (from, to) in [
        ("scope: !17)\n!37", "scope: !99)\n!37"),
        ("!17 = distinct !DILexicalBlock(scope: !15", "!17 = distinct !DILexicalBlock(scope: !17"),
        ("!17 = distinct !DILexicalBlock(", "!17 = !DICommonBlock("),
    ] {
        assert!(IR.contains(from));
        let text = translate(&IR.replace(from, to), Dialect::Llvm7).expect("translated").text;
        assert!(!text.contains("!DILocation(line: 12") && text.contains("!DILocation(line: 15"), "{text}");
        if let Ok(library) = choose() {
            compile(&library, &IR.replace(from, to), "75");
        }
    }
    let none = IR.replace("!dbg", "!noundef");
    assert!(!translate(&none, Dialect::Llvm7).expect("translated").text.contains("llvm.dbg.cu"));
}
