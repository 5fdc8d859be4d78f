//! Compiles the probe shaders to PTX, for the tests that run on a GPU as well.

fn main() {
    optix_toolchain::shaders("shaders");
}
