//! Compiles the peers' shader crate to PTX.

fn main() {
    optix_toolchain::shaders("shaders");
}
