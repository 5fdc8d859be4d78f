//! What is not translated is refused, with its place.

use optix_nvvm::{Dialect, translate};

#[test]
fn refusals_say_function_instruction_and_way_out() {
    let cases = [
        ("%1 = add bfloat 0xR0000, 0xR0000", "the type `bfloat`", "use integers of up to 128 bits"),
        (
            "%1 = call i32 @llvm.experimental.thing.i32(i32 5)",
            "the intrinsic `llvm.experimental.thing`",
            "--codegen rustc",
        ),
        ("%1 = fptoui float 1.000000e+00 to i200", "the type `i200`", "use integers"),
        ("%1 = atomicrmw nand ptr null, i32 5 seq_cst", "`nand` where an atomic operation", "--codegen rustc"),
        ("%1 = atomicrmw add ptr null, i8 5 seq_cst", "an atomic Int(8)", "32 or 64 bits"),
        ("%1 = invoke i32 @f() to label %2 unwind label %3", "unwinding", "panic"),
        (
            "%1 = call i100 @llvm.umul.with.overflow.i100(i100 5, i100 6)",
            "a checked multiplication of 100 bits",
            "64 bits",
        ),
        ("%1 = call half @llvm.fma.f16(half 0xH0000, half 0xH0000, half 0xH0000)", "`fma` of `f16`", "`f32`"),
        ("%1 = call float @llvm.maximum.f32(float 0.000000e+00)", "the intrinsic `llvm.maximum`", "--codegen rustc"),
        ("%1 = icmp above i32 5, 6", "`above` where a comparison of integers", "--codegen rustc"),
        ("%1 = fcmp eq float 0.0, 1.0", "`eq` where a comparison of floats", "--codegen rustc"),
        ("%1 = call i32 @llvm..sat.i32(i32 5, i32 6)", "the intrinsic `llvm..sat`", "--codegen rustc"),
        ("%1 = call i32 @\"llvm.ü.sat\"(i32 5, i32 6)", "the intrinsic `llvm.ü.sat`", "--codegen rustc"),
        ("%1 = frobnicate i32 5", "the instruction `frobnicate`", "--codegen rustc"),
        ("%1 = load i32, ptr @missing, align 4", "`@missing`, which is declared nowhere", "--codegen rustc"),
        ("%1 = call i32 @missing(i32 5)", "a call of `missing`", "--codegen rustc"),
        ("ret i32 5, !dbg", "metadata", "--codegen rustc"),
    ];
    for (line, reason, hint) in cases {
        let ir = format!("define void @_RNvNtCs1234_7shaders5glass6shadow() {{\n  {line}\n  ret void\n}}\n");
        let refusal = translate(&ir, Dialect::Llvm7).expect_err(line);
        let message = refusal.to_string();
        assert_eq!(refusal.function, "shaders::glass::shadow", "{message}");
        assert!(message.contains(reason), "{line}: {message}");
        assert!(message.contains(hint), "{line}: {message}");
        assert!(line.starts_with(&refusal.instruction), "{message}");
    }
}

#[test]
fn a_value_that_is_made_of_itself_is_refused() {
    let ir = "define i1 @f() {\n  %1 = call i1 @llvm.expect.i1(i1 %1, i1 true)\n  ret i1 %1\n}\n";
    let refusal = translate(ir, Dialect::Llvm7).expect_err("a circle");
    assert_eq!(
        (refusal.reason.as_str(), refusal.instruction.as_str()),
        ("a value that is made of itself", "ret i1 %1")
    );
}

#[test]
fn outside_of_functions_the_line_is_named() {
    for line in ["@a = alias i32, ptr @b", "@v = thread_local global i32 0", "declare bfloat @f()", "what is this"] {
        let refusal = translate(line, Dialect::Llvm7).expect_err(line);
        assert_eq!(refusal.instruction, line);
    }
}
