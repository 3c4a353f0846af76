# To be sourced by the tests of the demos' windows. They play under a virtual X server, with a real mouse and keys: what the user does is in
# the recording, and the replay ends in the same state, in a window and without.
#   NAME_test.sh SOFTCELL DROP_FILE [FOLDER FOR SCREENSHOTS]
set -euo pipefail
source "$(dirname "$0")/../../../ci/virtual-display"
softcell=$(realpath "$1")
drop_file=$(realpath "$2")
folder=$(mktemp -d)
shots=$(realpath "${3:-$folder}")
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$folder"' EXIT
fail() { echo "$(basename "$0" .sh): $*" >&2; sed 's/^/softcell: /' "$folder"/log >&2 || true; exit 1; }
cd "$folder"
start_virtual_display "$folder" 1400x800 || fail "Xvfb did not start"

# start VERB OPTIONS...: runs softcell and waits for its first picture. It is small, as the processor draws its pixels; `size=1280x720 start` has a
# larger one.
start() {
  "$softcell" demo "$1" --size "${size:-640x360}" "${@:2}" >"$folder/log" 2>&1 &
  pid=$!
  window=$(timeout 60 xdotool search --sync --onlyvisible --name "softcell demo $1" | head -1) || fail "no window"
  xdotool windowfocus --sync "$window"
  shot "begin_$1"  # what comes before the first picture meets nothing
  sleep 1
}
# finish: the user closes the window.
finish() {
  xdotool key Escape
  wait "$pid" || fail "ends with status $?"
}
# leave: the user presses Escape twice: for the menu and for the window. A large scene may still be loading.
leave() {
  xdotool key Escape key Escape
  wait "$pid" || fail "ends with status $?"
}
recorded() { grep -Eq "^[0-9]+ $1" "$folder/$2.rec" || fail "'$1' is not in the recording: $(cat "$folder/$2.rec")"; }
hash_of() { sed -n 's/^state: *\([0-9a-f]*\).*/\1/p' "$folder/log"; }
# same_again VERB NAME: the replay ends in the recorded state, without a window and in one.
same_again() {
  local hash
  hash=$(hash_of)
  for how in --headless --size=160x90; do
    "$softcell" demo "$1" --replay "$folder/$2.rec" "$how" --spes 2 >"$folder/log" 2>&1 || fail "the replay fails ($how)"
    [ "$(hash_of)" = "$hash" ] || fail "the replay ends in $(hash_of), not in $hash ($how)"
  done
}
# shot NAME: a picture of the window, as soon as it shows more than a plain background. (A large scene takes its time to be made under
# a sanitizer, on a machine that does other things too.)
shot() {
  local begin=$SECONDS
  while ((SECONDS - begin < 90)); do
    import -window "$window" "$shots/$1.png"
    [ "$(identify -format %k "$shots/$1.png")" -gt 100 ] && return
    sleep 0.1
  done
  fail "$1: the window does not show the scene"
}
# drop X Y FILE: a file is dropped onto the window's point.
drop() { "$drop_file" "$window" "$@" || fail "the window does not take $3"; }
# A model to be dropped.
make_tetrahedron() {
  cat >tetrahedron.obj <<'OBJ'
v 0 0 0
v 2 0 0
v 0 3 0
v 0 0 2
f 1 3 2
f 1 2 4
f 1 4 3
f 2 3 4
OBJ
}
