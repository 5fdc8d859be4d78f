//! What is known of a module is read, and what is not is left out.

use std::path::Path;

use optix_llvm_ir::model::{Callee, Op, Value};
use optix_llvm_ir::{Origins, known, module};

/// A function that was inlined into another, which a table has, which an entry uses. `line` is a place for one more
/// instruction.
fn ir(line: &str) -> String {
    let head = r#"
@table = private constant [1 x ptr] [ptr getelementptr inbounds (i8, ptr @listed, i64 0)], align 8
define void @listed(ptr %0) !dbg !3 {
start:
"#;
    let tail = r#"
  %2 = call noundef range(i32 0, 5) i32 %0(i32 7), !dbg !6
  ret void
}
define ptx_kernel void @__raygen__camera(ptr %0) #0 !dbg !4 {
  call void @listed(ptr @table), !dbg !8
  ret void
}
attributes #0 = { nounwind "target-cpu"="sm_75" }
!1 = !DIFile(filename: "src/lib.rs", directory: "/shaders", checksumkind: CSK_MD5, checksum: "00")
!2 = distinct !DISubprogram(name: "dive<u32>", scope: !1, file: !1, line: 1)
!3 = distinct !DISubprogram(name: "listed", scope: !1, file: !1, line: 10)
!4 = distinct !DISubprogram(name: "camera", scope: !1, file: !1, line: 20)
!5 = distinct !DILexicalBlock(scope: !2, file: !1, line: 2, column: 1)
!6 = !DILocation(line: 3, column: 1, scope: !5, inlinedAt: !7)
!7 = !DILocation(line: 12, column: 1, scope: !3)
!8 = !DILocation(line: 22, column: 1, scope: !4)
"#;
    format!("{head}{line}{tail}")
}

/// The functions that the call through a pointer comes from, with their lines.
fn origins(text: &str) -> Vec<(String, u32)> {
    let module = known(text);
    let is_call = |op: &Op| matches!(op, Op::Call(call) if matches!(call.callee, Callee::Function(Value::Local(_))));
    let (function, instruction) = module.instructions().find(|(_, one)| is_call(&one.op)).expect("there is one");
    let frames = Origins::new(&module).of(function, instruction);
    assert!(frames.iter().all(|frame| frame.file == Path::new("/shaders/src/lib.rs")));
    frames.into_iter().map(|frame| (frame.function.to_string(), frame.line)).collect()
}

fn expected() -> Vec<(String, u32)> {
    [("dive", 3), ("listed", 12), ("camera", 22)].map(|(name, line)| (name.to_string(), line)).to_vec()
}

#[test]
fn an_instruction_comes_from_what_was_inlined_and_from_what_uses_its_function() {
    assert_eq!(origins(&ir("")), expected());
    // By the table alone.
    assert_eq!(origins(&ir("").replace("call void @listed(ptr @table)", "store ptr @table, ptr %0")), expected());
    assert_eq!(origins(&ir("").replace("@listed(ptr @table)", "@other(ptr null)")), expected()[..2]);
}

#[test]
fn what_is_not_known_is_left_out() {
    for line in [
        "  %1 = frobnicate fp128 0xL0",
        "  switch fp128 %0, label %1 [\n    fp128 0xL0, label %2\n    fp128 0xL1, label %3\n  ]",
        "  %1 = invoke i32 @f() to label %2 unwind label %3\nsecond:",
        "  br label %second\nfirst:\n  frobnicate\nsecond:",
    ] {
        assert!(module(&ir(line)).is_err(), "{line}");
        assert_eq!(origins(&ir(line)), expected(), "{line}");
    }
    let newer = ["@alias = alias ptr, ptr @listed\n", "define fp128 @wide() frobnicates {\n  ret fp128 0xL0\n}\n"];
    let newer = newer.concat() + &ir("").replace("nounwind", "nounwind frobnicates(1, 2)");
    assert!(module(&newer).is_err());
    assert_eq!(origins(&newer), expected());
    assert_eq!(known("@\"").functions.len(), 0);
}

#[test]
fn what_is_known_is_read_by_both() {
    assert_eq!(module(&ir("")), Ok(known(&ir(""))));
}

#[test]
fn line_information_that_goes_round_ends() {
    for (from, to) in [("inlinedAt: !7", "inlinedAt: !6"), ("Block(scope: !2", "Block(scope: !5")] {
        let text = ir("");
        assert!(text.contains(from));
        let module = known(&text.replace(from, to));
        let origins = Origins::new(&module);
        module.instructions().for_each(|(function, instruction)| drop(origins.of(function, instruction)));
    }
}
