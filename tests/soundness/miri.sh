#!/usr/bin/env bash
# Runs under Miri what can be: the programs of tests/soundness, and the device crate's tests of words, views and handles. Tree Borrows,
# and several seeds for what threads share.
#
# Needs a nightly toolchain; adds its component miri if that is not there.
set -euo pipefail
cd "$(dirname "$0")/../.."

rustup component add --toolchain nightly miri rust-src >/dev/null
# Structures and rayon keep addresses as numbers, which is why provenance is permissive; rayon's threads outlive `main`.
export MIRIFLAGS="-Zmiri-tree-borrows -Zmiri-permissive-provenance -Zmiri-ignore-leaks -Zmiri-num-cpus=2 -Zmiri-disable-isolation ${MIRIFLAGS:-}"
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-target}/miri
cargo +nightly miri test --quiet --package optix-device-rs --lib -- words host
cargo +nightly miri test --quiet --package optix-soundness-tests --tests
for seed in 1 2 3; do
    MIRIFLAGS="$MIRIFLAGS -Zmiri-seed=$seed" cargo +nightly miri test --quiet --package optix-soundness-tests --test shared
done
