//! Constructs that occur in `core`, glam and shaders: libNVVM verifies and compiles each, on every architecture, and ptxas
//! assembles the result.

use super::{ARCHS, compile, library};

/// Functions, with what they need declared.
const CONSTRUCTS: &[&str] = &[
    // Numbers of every type, with the flags that only newer LLVM knows.
    "define i32 @flags(i32 noundef %0, i32 range(i32 0, 5) %1) {
        %3 = or disjoint i32 %0, %1
        %4 = zext nneg i32 %3 to i64
        %5 = trunc nuw nsw i64 %4 to i32
        %6 = icmp samesign ult i32 %5, %1
        %7 = uitofp nneg i32 %5 to float
        %8 = fadd nnan ninf nsz arcp contract afn reassoc float %7, 1.000000e+00
        %9 = fcmp fast oeq float %8, 0x3FB99999A0000000
        %10 = select nnan i1 %9, float %8, float 2.000000e+00
        %11 = fptosi float %10 to i32
        %12 = select i1 %6, i32 %11, i32 poison
        %13 = sdiv exact i32 %12, 3
        ret i32 %13
    }",
    "define i128 @wide(i128 %0, i128 %1) {
        %3 = mul i128 %0, %1
        %4 = udiv i128 %3, %1
        %5 = lshr i128 %4, 7
        %6 = freeze i128 %5
        ret i128 %6
    }",
    // Integers of other widths, as structs of some bytes are passed.
    "define i48 @passed(i24 %0, i48 zeroext %1, ptr %2) {
        %4 = call i24 @elsewhere(i24 %0, i40 5)
        %5 = zext i24 %4 to i48
        %6 = add i48 %5, %1
        %7 = call i56 %2(i48 %6)
        %8 = trunc i56 %7 to i48
        ret i48 %8
    }
    define i24 @elsewhere(i24 %0, i40 %1) noinline {
        %3 = trunc i40 %1 to i24
        %4 = mul i24 %0, %3
        ret i24 %4
    }",
    "define half @halves(half %0, half %1) {
        %3 = fmul half %0, %1
        %4 = fneg half %3
        %5 = call half @llvm.sqrt.f16(half %4)
        %6 = call half @llvm.floor.f16(half %5)
        %7 = freeze half %6
        %8 = call half @llvm.maxnum.f16(half %7, half 0xH3C00)
        ret half %8
    }
    declare half @llvm.sqrt.f16(half)
    declare half @llvm.floor.f16(half)
    declare half @llvm.maxnum.f16(half, half)",
    // Halves that libNVVM fails at by itself.
    "define void @eight_halves(ptr %0, half %1, half %2, half %3, half %4, half %5, half %6, half %7, half %8) {
        store half %1, ptr %0, align 16
        %p1 = getelementptr inbounds nuw i8, ptr %0, i64 2
        store half %2, ptr %p1, align 2
        %p2 = getelementptr inbounds nuw i8, ptr %0, i64 4
        store half %3, ptr %p2, align 4
        %p3 = getelementptr inbounds nuw i8, ptr %0, i64 6
        store half %4, ptr %p3, align 2
        %p4 = getelementptr inbounds nuw i8, ptr %0, i64 8
        store half %5, ptr %p4, align 8
        %p5 = getelementptr inbounds nuw i8, ptr %0, i64 10
        store half %6, ptr %p5, align 2
        %p6 = getelementptr inbounds nuw i8, ptr %0, i64 12
        store half %7, ptr %p6, align 4
        %p7 = getelementptr inbounds nuw i8, ptr %0, i64 14
        store half %8, ptr %p7, align 2
        ret void
    }",
    "define i128 @wide_of_half(half %0) {
        %2 = fptosi half %0 to i128
        %3 = fptoui half %0 to i128
        %4 = add i128 %2, %3
        ret i128 %4
    }",
    // Memory: addresses, structs, arrays, named types, variables, copies.
    "%pair = type { i32, [3 x float], ptr }
    @table = private unnamed_addr constant [4 x i32] [i32 1, i32 2, i32 3, i32 4], align 4
    @text = internal constant <{ [3 x i8], ptr }> <{ [3 x i8] c\"a\\00b\", ptr getelementptr inbounds nuw (i8, ptr @table, i64 8) }>, align 8
    @counter = internal addrspace(1) global i32 0, align 4
    @0 = private unnamed_addr constant { i64, [2 x i8] } { i64 5, [2 x i8] undef }, align 8
    define float @memory(ptr noalias noundef readonly align 8 captures(none) dereferenceable(32) %0, i64 %1) unnamed_addr {
        %3 = alloca [4 x i32], align 16
        call void @llvm.lifetime.start.p0(ptr nonnull %3)
        call void @llvm.memcpy.p0.p0.i64(ptr noundef nonnull align 16 dereferenceable(16) %3, ptr noundef nonnull align 4 @table, i64 16, i1 false)
        call void @llvm.memset.p0.i64(ptr align 8 %0, i8 0, i64 24, i1 false)
        call void @llvm.memmove.p0.p0.i64(ptr align 8 %0, ptr align 1 %3, i64 %1, i1 false)
        %4 = getelementptr inbounds nuw [4 x i32], ptr %3, i64 0, i64 %1
        %5 = load i32, ptr %4, align 4, !range !0, !noundef !1
        %6 = getelementptr inbounds nusw %pair, ptr %0, i64 1, i32 1, i64 2
        %7 = load float, ptr %6, align 4, !noundef !1
        %8 = getelementptr i8, ptr %0, i64 16
        %9 = load ptr, ptr %8, align 8, !nonnull !1, !align !2, !noundef !1
        %10 = load i32, ptr %9, align 4
        %11 = addrspacecast ptr addrspace(1) @counter to ptr
        store i32 %10, ptr %11, align 4, !noalias !3
        store volatile ptr @text, ptr %8, align 8
        %12 = ptrtoint ptr %9 to i64
        %13 = and i64 %12, -16
        %14 = inttoptr i64 %13 to ptr
        %15 = icmp eq ptr %14, null
        %16 = load i64, ptr @0, align 8
        store { i32, float } { i32 1, float 2.000000e+00 }, ptr %0, align 4
        call void @llvm.lifetime.end.p0(ptr nonnull %3)
        %17 = call ptr @llvm.ptrmask.p0.i64(ptr %9, i64 -8)
        %18 = ptrtoint ptr %17 to i64
        %19 = add i64 %18, %16
        %20 = uitofp i64 %19 to float
        %21 = select i1 %15, float %7, float %20
        ret float %21
    }
    declare void @llvm.lifetime.start.p0(ptr captures(none)) #0
    declare void @llvm.lifetime.end.p0(ptr captures(none)) #0
    declare void @llvm.memcpy.p0.p0.i64(ptr noalias writeonly captures(none), ptr noalias readonly captures(none), i64, i1 immarg) #1
    declare void @llvm.memmove.p0.p0.i64(ptr writeonly captures(none), ptr readonly captures(none), i64, i1 immarg)
    declare void @llvm.memset.p0.i64(ptr writeonly captures(none), i8, i64, i1 immarg)
    declare ptr @llvm.ptrmask.p0.i64(ptr, i64)
    attributes #0 = { mustprogress nocallback nofree nosync nounwind willreturn memory(argmem: readwrite) }
    attributes #1 = { nounwind \"target-cpu\"=\"sm_75\" allocsize(0) uwtable }
    !0 = !{i32 0, i32 100}
    !1 = !{}
    !2 = !{i64 8}
    !3 = !{!4}
    !4 = distinct !{!4, !5, !\"a: argument 0\"}
    !5 = distinct !{!5, !\"a\"}",
    // Control flow: loops, switches, phis before anything else, blocks with names.
    "define i32 @control(i32 %0, ptr %1) {
    start:
        br label %\"head of loop\"
    \"head of loop\":                      ; preds = %start, %\"head of loop\"
        %2 = phi i32 [ 0, %start ], [ %4, %\"head of loop\" ]
        %3 = phi ptr [ null, %start ], [ %1, %\"head of loop\" ]
        %4 = add nuw nsw i32 %2, 1
        store ptr %3, ptr %1, align 8
        %5 = icmp eq i32 %4, %0
        br i1 %5, label %6, label %\"head of loop\", !llvm.loop !0
    6:
        switch i32 %0, label %default [
            i32 0, label %7
            i32 -5, label %8
        ]
    7:
        ret i32 1
    8:
        br label %9
    9:
        br label %9
    default:
        call void @llvm.assume(i1 %5) [ \"align\"(ptr %1, i64 16) ]
        call void @llvm.assume(i1 true)
        call void @llvm.trap()
        unreachable
    }
    declare void @llvm.assume(i1 noundef)
    declare void @llvm.trap() noreturn
    !0 = distinct !{!0, !1}
    !1 = !{!\"llvm.loop.mustprogress\"}",
    // Calls: direct, indirect, by value, with results in a struct.
    "define internal fastcc { i32, i1 } @callee(i32 %0, ptr byval([2 x i32]) align 4 %1) noinline {
        %3 = load i32, ptr %1, align 4
        %4 = call { i32, i1 } @llvm.uadd.with.overflow.i32(i32 %0, i32 %3)
        ret { i32, i1 } %4
    }
    define i32 @caller(ptr %0, ptr %1) {
        %3 = tail call fastcc { i32, i1 } @callee(i32 5, ptr byval([2 x i32]) align 4 %0)
        %4 = extractvalue { i32, i1 } %3, 0
        %5 = insertvalue { i32, i1 } poison, i32 %4, 0
        %6 = extractvalue { i32, i1 } %5, 0
        %7 = call noundef i32 %1(i32 noundef %6, ptr %0) #0
        %8 = icmp eq ptr %1, @other
        %9 = zext i1 %8 to i32
        %10 = add i32 %9, %7
        ret i32 %10
    }
    define i32 @other(i32 %0, ptr %1) { ret i32 %0 }
    declare { i32, i1 } @llvm.uadd.with.overflow.i32(i32, i32)
    attributes #0 = { nounwind memory(inaccessiblemem: readwrite, target_mem0: none) }",
    // Vectors, which the optimiser makes.
    "define <4 x i8> @vectors(<4 x i8> %0, <2 x float> %1, <4 x i32> %2) {
        %4 = add <4 x i8> %0, splat (i8 3)
        %5 = call <4 x i8> @llvm.umin.v4i8(<4 x i8> %4, <4 x i8> splat (i8 100))
        %6 = freeze <4 x i8> %5
        %7 = shufflevector <4 x i8> %6, <4 x i8> poison, <4 x i32> <i32 3, i32 poison, i32 1, i32 0>
        %8 = fneg <2 x float> %1
        %9 = call <2 x float> @llvm.fma.v2f32(<2 x float> %8, <2 x float> %1, <2 x float> zeroinitializer)
        %10 = call float @llvm.vector.reduce.fadd.v2f32(float -0.000000e+00, <2 x float> %9)
        %11 = call i8 @llvm.fptoui.sat.i8.f32(float %10)
        %12 = insertelement <4 x i8> %7, i8 %11, i64 0
        %13 = extractelement <4 x i8> %12, i64 2
        %14 = call i32 @llvm.vector.reduce.smax.v4i32(<4 x i32> %2)
        %15 = trunc i32 %14 to i8
        %16 = add i8 %13, %15
        %17 = insertelement <4 x i8> %12, i8 %16, i64 1
        ret <4 x i8> %17
    }
    declare <4 x i8> @llvm.umin.v4i8(<4 x i8>, <4 x i8>)
    declare <2 x float> @llvm.fma.v2f32(<2 x float>, <2 x float>, <2 x float>)
    declare float @llvm.vector.reduce.fadd.v2f32(float, <2 x float>)
    declare i8 @llvm.fptoui.sat.i8.f32(float)
    declare i32 @llvm.vector.reduce.smax.v4i32(<4 x i32>)",
    // Atomics in every ordering.
    "define i32 @atomics(ptr %0, ptr addrspace(3) %1, ptr %2) {
        %4 = load atomic i32, ptr %0 monotonic, align 4
        %5 = load atomic i8, ptr %2 acquire, align 1
        store atomic i64 7, ptr %2 seq_cst, align 8
        store atomic i16 7, ptr %2 release, align 2
        %6 = atomicrmw add ptr %0, i32 %4 monotonic, align 4
        %7 = atomicrmw sub ptr %0, i32 %6 seq_cst, align 4
        %8 = atomicrmw umax ptr addrspace(3) %1, i64 5 acq_rel, align 8
        %9 = atomicrmw fadd ptr %0, float 1.000000e+00 monotonic, align 4
        %10 = cmpxchg weak ptr %0, i32 %7, i32 1 acq_rel monotonic, align 4
        %11 = extractvalue { i32, i1 } %10, 0
        %12 = atomicrmw xchg ptr %2, i64 0 release, align 8
        fence syncscope(\"block\") acquire
        fence seq_cst
        %13 = zext i8 %5 to i32
        %14 = add i32 %11, %13
        ret i32 %14
    }",
    // Inline assembly, with many results.
    "module asm \".visible .const .align 8 .b8 frame[16];\"
    define ptx_kernel void @kernel() unnamed_addr #0 {
        %1 = tail call i32 asm \"ld.const.u32 $0, [frame+8];\", \"=r\"() #1, !srcloc !0
        %2 = tail call { i32, i32 } asm sideeffect \"mov.b32 $0, $2; mov.b32 $1, $3;\", \"=&r,=&r,r,r,~{memory}\"(i32 %1, i32 5) #2
        %3 = extractvalue { i32, i32 } %2, 1
        %4 = inttoptr i32 %3 to ptr
        store i32 %3, ptr %4, align 4
        ret void
    }
    attributes #0 = { nounwind \"target-cpu\"=\"sm_75\" }
    attributes #1 = { nounwind willreturn memory(none) }
    attributes #2 = { nounwind memory(write, inaccessiblemem: readwrite) }
    !0 = !{i64 1234}",
    // Everything that libdevice has, by LLVM's names and by C's.
    "define float @maths(float %0, double %1) {
        %3 = call float @llvm.sin.f32(float %0)
        %4 = call float @llvm.pow.f32(float %3, float %0)
        %5 = call float @sinf(float %4)
        %6 = call double @atan2(double %1, double %1)
        %7 = frem float %5, %0
        %8 = call float @llvm.powi.f32.i32(float %7, i32 3)
        %9 = fptrunc double %6 to float
        %10 = call { float, float } @llvm.sincos.f32(float %8)
        %11 = extractvalue { float, float } %10, 1
        %12 = fadd float %9, %11
        %13 = call float @llvm.exp2.f32(float %12)
        %14 = call float @llvm.tan.f32(float %13)
        ret float %14
    }
    declare float @llvm.sin.f32(float)
    declare float @llvm.pow.f32(float, float)
    declare float @sinf(float)
    declare double @atan2(double, double)
    declare float @llvm.powi.f32.i32(float, i32)
    declare { float, float } @llvm.sincos.f32(float)
    declare float @llvm.exp2.f32(float)
    declare float @llvm.tan.f32(float)",
];

/// Functions of one float.
const OF_FLOATS: [&str; 9] = ["fabs", "sqrt", "floor", "ceil", "trunc", "rint", "nearbyint", "roundeven", "round"];
/// Functions of two.
const OF_TWO_FLOATS: [&str; 7] = ["copysign", "minnum", "maxnum", "minimum", "maximum", "minimumnum", "maximumnum"];

/// A function for each intrinsic on floats, and for each conversion.
fn floats() -> String {
    let mut ir = String::new();
    for (ty, suffix) in [("float", "f32"), ("double", "f64"), ("half", "f16")] {
        for name in OF_FLOATS {
            ir += &format!("declare {ty} @llvm.{name}.{suffix}({ty})\n");
            ir += &format!(
                "define {ty} @{name}_{suffix}({ty} %0) {{\n  %2 = call {ty} @llvm.{name}.{suffix}({ty} %0)\n  ret {ty} %2\n}}\n"
            );
        }
        for name in OF_TWO_FLOATS {
            ir += &format!("declare {ty} @llvm.{name}.{suffix}({ty}, {ty})\n");
            ir += &format!(
                "define {ty} @{name}_{suffix}({ty} %0, {ty} %1) {{\n  %3 = call {ty} @llvm.{name}.{suffix}({ty} %0, {ty} %1)\n  ret {ty} %3\n}}\n"
            );
        }
        for bits in [8, 16, 32, 64] {
            for name in ["fptosi", "fptoui"] {
                ir += &format!("declare i{bits} @llvm.{name}.sat.i{bits}.{suffix}({ty})\n");
                ir += &format!(
                    "define i{bits} @{name}_{bits}_{suffix}({ty} %0) {{\n  %2 = call i{bits} @llvm.{name}.sat.i{bits}.{suffix}({ty} %0)\n  ret i{bits} %2\n}}\n"
                );
            }
        }
    }
    ir
}

#[test]
fn libnvvm_and_ptxas_accept_every_construct() {
    let test = "libnvvm_and_ptxas_accept_every_construct";
    let Some(library) = library(test) else { return };
    let floats = floats();
    for arch in ARCHS {
        for ir in CONSTRUCTS.iter().copied().chain([floats.as_str()]) {
            let ptx = compile(&library, ir, arch);
            assert!(!ptx.contains(".extern .func"), "a function that nobody defines:\n{ptx}");
            assemble(&ptx, arch);
        }
    }
}

/// Has ptxas assemble it, where ptxas is there.
pub(super) fn assemble(ptx: &str, arch: &str) {
    let Some(ptxas) = optix_toolchain::inspect::ptxas::Ptxas::find() else { return };
    let folder = std::env::temp_dir();
    let file = folder.join(format!("optix-nvvm-{}-{arch}.ptx", std::process::id()));
    std::fs::write(&file, ptx).expect("the temporary folder is writable");
    let output = std::process::Command::new(&ptxas.program)
        .args([&format!("-arch=sm_{arch}"), "--output-file", "/dev/null"])
        .arg(&file)
        .output()
        .expect("ptxas runs");
    let _ = std::fs::remove_file(&file);
    let text = String::from_utf8_lossy(&output.stderr);
    // An older ptxas than libNVVM can't say anything.
    assert!(output.status.success() || text.contains("Unsupported .version"), "{text}\n{ptx}");
}

/// The instructions of a function in PTX, one after the other.
fn instructions(ptx: &str, function: &str) -> String {
    let begin = ptx.find(&format!(") {function}(")).unwrap_or_else(|| panic!("no {function}"));
    let body = &ptx[begin..];
    body[..body.find("\n}").unwrap_or(body.len())].to_string()
}

#[test]
fn intrinsics_are_the_instructions_they_stand_for() {
    let Some(library) = library("intrinsics_are_the_instructions_they_stand_for") else { return };
    let ptx = compile(&library, &floats(), "75");
    for (function, instruction) in [
        ("fabs_f32", "abs.f32"),
        ("sqrt_f32", "sqrt.rn.f32"),
        ("trunc_f64", "cvt.rzi.f64.f64"),
        ("roundeven_f32", "cvt.rni.f32.f32"),
        ("rint_f64", "cvt.rni.f64.f64"),
        ("maxnum_f32", "max.f32"),
        ("minimumnum_f64", "min.f64"),
        ("round_f32", "0f3EFFFFFF"),
        ("round_f64", "0d3FDFFFFFFFFFFFFF"),
        ("fptosi_32_f32", "cvt.rzi.s32.f32"),
        ("fptoui_8_f32", "cvt.rzi.u32.f32"),
        ("fptosi_64_f64", "cvt.rzi.s64.f64"),
    ] {
        let body = instructions(&ptx, function);
        assert!(body.contains(instruction), "{function} has no {instruction}:\n{body}");
    }
    // NaN to 0: only from `float` to 32 bits does the instruction do so.
    assert!(!instructions(&ptx, "fptosi_32_f32").contains("setp.nan"));
    for function in ["fptosi_32_f64", "fptoui_64_f32", "fptosi_64_f64"] {
        let body = instructions(&ptx, function);
        assert!(body.contains("setp.nan") || body.contains("setp.num"), "{function}:\n{body}");
    }
}

#[test]
fn stores_side_by_side_are_one() {
    let Some(library) = library("stores_side_by_side_are_one") else { return };
    let stores = |align: u32, between: &str| {
        let text = format!(
            "define i32 @put(ptr %0, float %1, float %2, ptr %3) {{
                store float %1, ptr %0, align {align}
                %5 = getelementptr inbounds nuw i8, ptr %0, i64 4
                store float %2, ptr %5, align 4
                {between}
                %7 = getelementptr inbounds nuw i8, ptr %0, i64 8
                store float %2, ptr %7, align 8
                %8 = getelementptr inbounds nuw i8, ptr %0, i64 12
                store float 1.0, ptr %8, align 4
                ret i32 0
            }}"
        );
        let ptx = compile(&library, &text, "75");
        ["st.v4.f32", "st.v2.f32", "st.f32"].map(|store| instructions(&ptx, "put").matches(store).count())
    };
    let nothing = "%6 = getelementptr i8, ptr %3, i64 4";
    assert_eq!(stores(16, nothing), [1, 0, 0]);
    assert_eq!(stores(8, nothing), [0, 2, 0]);
    assert_eq!(stores(4, nothing)[2], 4 - 2 * stores(4, nothing)[1], "what may be unaligned stays apart");
    // The other pointer may lead to the same place.
    assert_eq!(stores(16, "%6 = load volatile float, ptr %3"), [0, 2, 0]);
}

/// Texts to start from.
pub(super) fn seeds() -> Vec<String> {
    CONSTRUCTS.iter().map(|text| text.to_string()).chain([floats()]).collect()
}
