#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the libraries that decode pictures from Debian's sources, with AddressSanitizer and libFuzzer's counters, so that the harness `image`
# finds its way through them and sees what they read and write beyond their memory. `./dev fuzz decoders` calls this; three minutes of a processor.
#
#   decoders.sh FOLDER   sources and libraries go into FOLDER/decoders; run.sh uses those in root/lib there
set -euo pipefail

work=$(mkdir -p "$1/decoders" && cd "$1/decoders" && pwd)
root=$work/root
cd "$work"

# Debian's sources have lists of their own here: nothing of the machine's set-up changes.
fetch() {
  local release options
  release=$(. /etc/os-release && echo "$VERSION_CODENAME")
  mkdir -p apt/lists/partial apt/cache
  echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian $release main" >apt/sources.list
  options=(-q -o Dir::Etc::sourcelist="$work/apt/sources.list" -o Dir::Etc::sourceparts=/dev/null
    -o Dir::State::lists="$work/apt/lists" -o Dir::Cache="$work/apt/cache" -o APT::Sandbox::User=root)
  apt-get "${options[@]}" update
  apt-get "${options[@]}" source openexr tiff libpng1.6 libjpeg-turbo openjpeg2 libwebp giflib
}

flags="-fsanitize=address,fuzzer-no-link -fno-omit-frame-pointer -g1 -O1"

# with_cmake SOURCE OPTION…
with_cmake() {
  local source
  source=$(find . -maxdepth 1 -type d -name "$1-*" -print -quit)
  shift
  cmake -S "$source" -B "$source-build" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_C_COMPILER=clang-14 -DCMAKE_CXX_COMPILER=clang++-14 \
    -DCMAKE_C_FLAGS="$flags" -DCMAKE_CXX_FLAGS="$flags" -DBUILD_SHARED_LIBS=ON -DCMAKE_INSTALL_PREFIX="$root" -DCMAKE_INSTALL_LIBDIR=lib "$@"
  cmake --build "$source-build"
  cmake --install "$source-build"
}

[[ ! -f .built ]] || exit 0
fetch
with_cmake openexr -DBUILD_TESTING=OFF -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF
with_cmake libpng1.6 -DPNG_TESTS=OFF -DPNG_STATIC=OFF
with_cmake libjpeg-turbo -DWITH_SIMD=OFF -DENABLE_STATIC=OFF -DCMAKE_INSTALL_LIBDIR="$root/lib"
with_cmake openjpeg2 -DBUILD_CODEC=OFF
with_cmake tiff -Dtiff-tools=OFF -Dtiff-tests=OFF -Dtiff-docs=OFF
with_cmake libwebp -DWEBP_BUILD_{ANIM_UTILS,CWEBP,DWEBP,GIF2WEBP,IMG2WEBP,VWEBP,WEBPINFO,WEBPMUX,EXTRAS}=OFF
make -C "$(find . -maxdepth 1 -type d -name 'giflib-*' -print -quit)" CC="clang-14 $flags -fPIC" libgif.so
cp giflib-*/libgif.so "$root/lib/libgif.so.7"
touch .built
