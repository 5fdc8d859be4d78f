#!/usr/bin/env bash
# Makes what the crate cust needs of a CUDA toolkit to be built and linked, where there is none:
#
#   tests/cust/stub.sh DIR && CUDA_LIBRARY_PATH=DIR cargo test --package optix-cust-tests --features cust --test cust
#
# DIR/lib64/libcuda.so has each function of the CUDA driver that cust declares, as the toolkit's own stub does, and
# fails as one does: CUDA_ERROR_STUB_LIBRARY. A program that is linked with it takes the driver's, if that is there.
set -euo pipefail
mkdir -p "$1/lib64"
root=$(cd "$1" && pwd)
cd "$(dirname "$0")"
manifest=$(cargo metadata --format-version 1 --features cust | grep -o '"[^"]*/cust_raw-[^"]*/Cargo.toml"' | tr -d '"' | head -n 1)
sed -n 's/^ *pub fn \(cu[A-Za-z0-9_]*\)(.*/int \1(void) { return 34; }/p' "$(dirname "$manifest")/src/cuda.rs" >"$root/stub.c"
cc -shared -fPIC -w -Wl,-soname,libcuda.so.1 -o "$root/lib64/libcuda.so.1" "$root/stub.c"
ln -sf libcuda.so.1 "$root/lib64/libcuda.so"
