//! Compiles the tests' shaders to PTX, for those that run on a GPU as well.

fn main() {
    optix_toolchain::shaders("shaders");
    optix_toolchain::shaders("maths");
    optix_toolchain::shaders("round-trip");
}
