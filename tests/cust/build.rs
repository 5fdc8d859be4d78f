//! Compiles the tests' shaders to PTX.

fn main() {
    optix_toolchain::shaders("../shaders");
}
