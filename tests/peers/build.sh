#!/usr/bin/env bash
# Compiles the loads' programs to PTX: a folder for each code generator.
#
#   NVCC=.../nvcc OPTIX_INCLUDE=.../include tests/peers/build.sh OUT
#
# OPTIX_INCLUDE has the headers of OptiX 9.0 (github.com/NVIDIA/optix-dev).
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=${1:?where the PTX goes}

mkdir -p "$out"/nvcc "$out"/nvcc-exact
for source in "$here"/cuda/*.cu; do
    name=$(basename "$source" .cu)
    # Relocatable, or nvcc would check that OptiX's functions are defined.
    compile=("${NVCC:-nvcc}" -ptx -rdc=true -arch="${CUDA_ARCH:-compute_75}" -I "${OPTIX_INCLUDE:?OptiX headers}" "$source")
    "${compile[@]}" -o "$out/nvcc/$name.ptx"
    "${compile[@]}" -fmad=false -o "$out/nvcc-exact/$name.ptx"
done

# The Rust programs by each generator of ours, with nvcc's defaults, then without contraction.
target=${CARGO_TARGET_DIR:-$here/../../target}
rust() {
    local folder=$1
    shift
    mkdir -p "$out/$folder"
    for crate in "$here/shaders" "$here/../../examples/path-tracer/shaders"; do
        (cd "$here" && cargo optix build --crate "$crate" "$@")
    done
    cp "$target"/optix/ptx/{peer_shaders,path_tracer_shaders}.ptx "$out/$folder/"
}
rust rustc
rust rustc-exact --fmad=false
# Not in a pipe: `grep -q` would end doctor before it is done.
found=$(cargo optix doctor || true)
if grep -q "ok *libNVVM" <<<"$found"; then
    rust nvvm --codegen nvvm
    rust nvvm-exact --codegen nvvm --fmad=false
fi
