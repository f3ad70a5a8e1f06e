#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes Debian packages and a relocatable archive of a build (CMake preset `package`): tools/package.sh BUILD OUTPUT.
# Called by `./dev package`. Needs dpkg-dev, patchelf, zstd. The same sources give the same bytes: times are those of the commit.
set -euo pipefail
build=$(cd "$1" && pwd)
mkdir -p "$2"
out=$(cd "$2" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cached() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }
version=$(cached CMAKE_PROJECT_VERSION)
name=afterglow-$version-linux-$(uname -m)
SOURCE_DATE_EPOCH=$(cached AFTERGLOW_COMMIT_TIME)
export SOURCE_DATE_EPOCH

# Packages. Files get the time of the commit, so that packing them twice gives the same archive. Nothing in the folder is touched
# but what has a name of these.
(cd "$build" && umask 022 && cpack -G DEB -B "$scratch/pack" >"$build/cpack.log") || { tail -n 20 "$build/cpack.log" >&2; exit 1; }
debs=()
for deb in "$scratch"/pack/*.deb; do
  tree=$scratch/deb
  mkdir -m 755 "$tree"  # becomes the package's own `./`
  dpkg-deb -R "$deb" "$tree"
  find "$tree" -path "$tree/DEBIAN" -prune -o -path '*/share/man/*' -name '*.1' -exec gzip -9n {} +
  if soname=$(basename -a "$tree"/usr/lib/*/libafterglow.so.? "$tree"/usr/lib/libafterglow.so.? 2>/dev/null | grep -x 'libafterglow.so.[0-9]*' | head -n 1); then
    rm -f "$tree/DEBIAN/postinst" "$tree/DEBIAN/postrm"
    echo 'activate-noawait ldconfig' >"$tree/DEBIAN/triggers"
    echo "libafterglow ${soname##*.} libafterglow${soname##*.} (>= $version)" >"$tree/DEBIAN/shlibs"
  fi
  (cd "$tree" && find . -path ./DEBIAN -prune -o -type f -printf '%P\0' | LC_ALL=C sort -z | xargs -0 md5sum >DEBIAN/md5sums)
  find "$tree" -exec touch -hd "@$SOURCE_DATE_EPOCH" {} +
  made=$out/$(basename "$deb")
  dpkg-deb --root-owner-group -Zxz -b "$tree" "$scratch/whole.deb" >/dev/null
  mv "$scratch/whole.deb" "$made"
  debs+=("$made")
  rm -rf "$tree"
done

# The archive: the program and the library with every library that they need, but for those of the C library, of the compiler
# (drivers need the system's own, which may be newer) and of drivers.
tree=$scratch/archive
top=$tree/$name
for component in program library data development; do
  cmake --install "$build" --prefix "$top" --component "$component" --strip >/dev/null
done
libraries=$(find "$top" -name '*.so*' -type f)
lib=$(dirname "$(find "$top" -name 'libafterglow.so.?' | head -n 1)")
wanted() {
  # shellcheck disable=SC2086 # a list
  ldd "$top/bin/afterglow" $libraries 2>/dev/null | awk '$2 == "=>" && $3 ~ /^\// { print $3 }' | sort -u |
    grep -vE '/(lib(c|m|dl|rt|pthread|resolv|util|stdc\+\+|gcc_s)\.so|libafterglow|ld-linux)'
}
mkdir -p "$top/licences"
{ wanted; ls /usr/lib/"$(uname -m)"-linux-gnu/libvulkan.so.1; } | while read -r file; do
  cp -L "$file" "$lib/$(basename "$file")"
  package=$(dpkg -S "$(realpath "$file")" 2>/dev/null | head -n 1 | cut -d: -f1 || true)
  [[ -z $package || ! -f /usr/share/doc/$package/copyright ]] || cp -L "/usr/share/doc/$package/copyright" "$top/licences/$package"
done
# Those whose code is in the program itself: linked statically, headers, embedded. THIRD_PARTY.md names the packages that it is
# built with, and a test holds it to that.
grep -oE '^\| [^|]+\| `[^|]+' "$root/THIRD_PARTY.md" | grep -oE '`[a-z0-9.+-]+`' | tr -d '`' | while read -r package; do
  [[ ! -f /usr/share/doc/$package/copyright ]] || cp -L "/usr/share/doc/$package/copyright" "$top/licences/$package"
done
cp "$root/LICENSE" "$root/THIRD_PARTY.md" "$top"
# By RPATH, not RUNPATH: it holds for the libraries of libraries too.
patchelf --force-rpath --set-rpath "\$ORIGIN/../${lib#"$top"/}" "$top/bin/afterglow"
patchelf --force-rpath --set-rpath '$ORIGIN' "$lib"/libafterglow.so.*.*
find "$lib/afterglow" -name '*.so' -exec patchelf --force-rpath --set-rpath '$ORIGIN/..' {} +
tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$SOURCE_DATE_EPOCH" -C "$tree" -cf - "$name" | zstd -q -12 -T0 -f -o "$scratch/$name.tar.zst"
mv "$scratch/$name.tar.zst" "$out"

du -h --apparent-size "${debs[@]}" "$out/$name.tar.zst"
printf 'program and library, stripped: %s, %s\n' "$(du -h --apparent-size "$top/bin/afterglow" | cut -f1)" "$(du -hL --apparent-size "$lib/libafterglow.so.0" | cut -f1)"
