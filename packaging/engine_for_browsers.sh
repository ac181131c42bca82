#!/bin/sh
# Compiles the engine for browsers (`mascarin page`) into the file that is given, where Rust has their target. In a folder of its own:
# Cargo locks a folder while it builds. Without the target the file is removed: an old engine would not be that of the package.
set -eu
out=$1
target=wasm32-unknown-unknown
if ! [ -d "$(rustc --print sysroot)/lib/rustlib/$target" ]; then
    rm -f "$out"
    echo "no engine for browsers (mascarin page): rustup target add $target, then make build" >&2
    exit 0
fi
RUSTFLAGS="-C target-feature=+simd128" cargo build --profile web --package mascarin-web --lib --target "$target" \
    --target-dir target/browsers --locked --quiet
cp "target/browsers/$target/web/mascarin_web.wasm" "$out"
