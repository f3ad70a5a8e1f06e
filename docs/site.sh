#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the documents into a static site: every Markdown file of the project as a page with navigation, the pictures and files that the pages
# link, nothing from elsewhere. Needs cmark-gfm (Debian: cmark-gfm).
#   docs/site.sh FOLDER     FOLDER is made, or brought up to date; open FOLDER/README.html (index.html is the same)
set -euo pipefail
[[ $# -eq 1 ]] || { sed -n '3,5s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")/.."
command -v cmark-gfm >/dev/null || { echo "docs/site.sh: error: cmark-gfm is not installed" >&2; exit 1; }

# Pages, in the order of the navigation: file and title.
pages=(
  "README.md|Afterglow"
  "docs/gallery.md|Gallery"
  "docs/looks.md|Looks"
  "docs/effects.md|Effects"
  "docs/composition.md|Composing looks"
  "docs/player.md|The player"
  "docs/video.md|Videos"
  "docs/writing_effects.md|Writing an effect"
  "docs/shader_library.md|The shader library"
  "docs/tone_mapping.md|Tone curves"
  "docs/alpha.md|Soft edges"
  "docs/ocio.md|OpenColorIO"
  "docs/formats.md|Formats"
  "docs/embedding.md|Embedding"
  "docs/farms.md|Farms"
  "docs/determinism.md|The same pixels"
  "docs/building.md|Building and packaging"
  "docs/stability.md|What is stable"
  "docs/reliability.md|What one can rely on"
  "docs/math.md|The mathematics"
  "docs/benchmarks/README.md|Benchmarks"
  "docs/benchmarks/flicker.md|Flicker"
  "docs/benchmarks/stability.md|Steadiness"
  "docs/benchmarks/effects.md|Effects in numbers"
  "CONTRIBUTING.md|Working on it"
  "tests/images/README.md|Test pictures"
  "CHANGELOG.md|Changes"
  "THIRD_PARTY.md|What comes from others"
)

# The way from a page back to the top of the site.
up() { local depth=${1//[!\/]/}; printf '%s' "${depth//\//../}"; }

navigation() { # PAGE
  local entry file title here
  for entry in "${pages[@]}"; do
    file=${entry%%|*} title=${entry#*|} here=
    [[ $file == "$1" ]] && here=' class="here" aria-current="page"'
    printf '<a href="%s%s.html"%s>%s</a>\n' "$(up "$1")" "${file%.md}" "$here" "$title"
  done
}

# The headings of a page, for its own navigation; ids as GitHub makes them, so that links to "#name" work in both places.
contents() { # HTML
  sed -n 's|^<h2 id="\([^"]*\)">\(.*\)</h2>$|<a href="#\1">\2</a>|p' "$1"
}

# Ids for headings; links to .md files become links to .html files, except to pages elsewhere.
finish() {
  awk '
    function id_of(text) {
      gsub(/<[^>]*>/, "", text); gsub(/&[a-z]+;/, "", text); text = tolower(text)
      gsub(/[^a-z0-9_ -]/, "", text); gsub(/ /, "-", text)
      if (seen[text]++) text = text "-" (seen[text] - 1)
      return text
    }
    match($0, /^<h[1-6]>/) {
      level = substr($0, 3, 1); text = substr($0, 5); sub(/<\/h[1-6]>$/, "", text)
      $0 = "<h" level " id=\"" id_of(text) "\">" text "</h" level ">"
    }
    {
      line = $0; result = ""
      while (match(line, /href="[^"]*\.md(#[^"]*)?"/)) {
        link = substr(line, RSTART, RLENGTH)
        if (link !~ /:\/\//) sub(/\.md/, ".html", link)
        result = result substr(line, 1, RSTART - 1) link
        line = substr(line, RSTART + RLENGTH)
      }
      line = result line; result = ""
      # A link to a folder is a link to its page.
      while (match(line, /href="[^":#]*\/"/)) {
        link = substr(line, RSTART, RLENGTH - 1) "README.html\""
        result = result substr(line, 1, RSTART - 1) link
        line = substr(line, RSTART + RLENGTH)
      }
      print result line
    }'
}

# A picture whose title is "before: FILE" becomes two, one over the other, with a slider between them; where FILE stands above it alone, it goes.
compare() {
  sed -zE 's|<p><img src="([^"]*/)([^"/]*)"[^>]*/></p>\n(<p><img src="[^"]*" alt="[^"]*" title="before: \2" /></p>)|\3|g' | sed -E 's|<p><img src="([^"]*/)([^"/]*)" alt="([^"]*)" title="before: ([^"]*)" /></p>|<figure class="compare"><img src="\1\2" alt="\3"><img src="\1\4" alt="before"><input type="range" value="50" aria-label="how much of the picture is before \3" oninput="this.parentNode.style.setProperty(\x27--at\x27, this.value + \x27%\x27)"></figure>|'
}

page() { # FILE TITLE
  local file=$1 title=$2 target=$out/${1%.md}.html body
  body=$(mktemp)
  cmark-gfm --unsafe -e table -e strikethrough -e autolink "$file" | finish | compare >"$body"
  mkdir -p "$(dirname "$target")"
  {
    printf '<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<meta name="viewport" content="width=device-width">\n'
    printf '<title>%s</title>\n<link rel="stylesheet" href="%ssite.css">\n<nav>\n' "$title" "$(up "$file")"
    navigation "$file"
    printf '</nav>\n<aside>\n'
    contents "$body"
    printf '</aside>\n<main>\n'
    cat "$body"
    printf '</main>\n</html>\n'
  } >"$target"
  rm -f "$body"
}

# Every local file that a page links or shows comes along.
copy_links() { # FILE
  local folder link target
  folder=$(dirname "$1")
  { grep -oE '(href|src)="[^"]+"' "$out/${1%.md}.html" || true; } | sed 's/^[a-z]*="//; s/"$//; s/#.*//' | sort -u |
    while read -r link; do
      [[ -z $link || $link == *://* || $link == *.html || $link == *site.css ]] && continue
      target=$(realpath -m --relative-to=. "$folder/$link")
      [[ -f $target ]] || continue
      mkdir -p "$out/$(dirname "$target")"
      cp -u "$target" "$out/$target"
    done
  # Pages that are written by hand or by a program, like those of the benchmarks.
  { grep -oE 'href="[^":]+\.html"' "$out/${1%.md}.html" || true; } | sed 's/^href="//; s/"$//' | sort -u |
    while read -r link; do
      target=$(realpath -m --relative-to=. "$folder/$link")
      [[ -f $target ]] && mkdir -p "$out/$(dirname "$target")" && cp -u "$target" "$out/$target"
    done || true
}

cat >"$out/site.css" <<'CSS'
:root { color-scheme: light dark; --line: #8884; --faint: #8881; }
body { margin: 0 auto; max-width: 80rem; display: grid; grid-template-columns: 14rem minmax(0, 1fr); gap: 0 2rem; padding: 1rem;
  font: 16px/1.5 system-ui, sans-serif; }
nav { grid-column: 1 / -1; display: flex; flex-wrap: wrap; gap: .2rem 1.2rem; border-bottom: 1px solid var(--line); padding-bottom: .6rem; }
nav a, aside a { text-decoration: none; color: inherit; }
nav a.here { font-weight: 600; }
nav a:hover, aside a:hover { text-decoration: underline; }
aside { display: flex; flex-direction: column; gap: .15rem; font-size: .9rem; padding-top: 1.6rem; position: sticky; top: 0; align-self: start;
  max-height: 100vh; overflow: auto; }
main { grid-column: 2; }
img { max-width: 100%; height: auto; }
.compare { position: relative; margin: 1em 0; --at: 50%; }
.compare img { display: block; width: 100%; }
.compare img + img { position: absolute; inset: 0; clip-path: inset(0 calc(100% - var(--at)) 0 0); border-right: 0; }
.compare::after { content: ""; position: absolute; top: 0; bottom: 0; left: var(--at); width: 2px; background: #fff; pointer-events: none; }
.compare input { position: absolute; inset: 0; width: 100%; height: 100%; margin: 0; opacity: 0; cursor: ew-resize; }
table { border-collapse: collapse; display: block; overflow-x: auto; }
td, th { border: 1px solid var(--line); padding: .25rem .6rem; text-align: left; vertical-align: top; }
code { font: .9em ui-monospace, monospace; background: var(--faint); padding: .1em .25em; border-radius: 3px; }
pre { background: var(--faint); padding: .8rem; overflow-x: auto; border-radius: 5px; }
pre code { background: none; padding: 0; }
@media (max-width: 50rem) { body { display: block; } aside { display: none; } }
CSS
for entry in "${pages[@]}"; do page "${entry%%|*}" "${entry#*|}"; done
for entry in "${pages[@]}"; do copy_links "${entry%%|*}"; done
sed 's/^<meta charset/<meta http-equiv="refresh" content="0; url=README.html">\n&/' "$out/README.html" >"$out/index.html"
