#!/usr/bin/env bash
# The window under a virtual X server: it opens, shows the scene, takes keys and the mouse, follows its size, closes. Without a
# display it says so in one sentence.
#   window_test.sh PROBE
set -euo pipefail
source "$(dirname "$0")/../../ci/virtual-display"
probe=$1
folder=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$folder"' EXIT
trap 'echo "window_test: line $LINENO ended with status $?" >&2' ERR
fail() { echo "window_test: $*" >&2; sed 's/^/probe: /' "$folder"/log >&2 || true; exit 1; }

# No display: one sentence, and the way out.
if env -u DISPLAY -u WAYLAND_DISPLAY SDL_VIDEODRIVER=x11 "$probe" once >"$folder/log" 2>&1; then
  fail "opened a window without a display"
fi
[ "$(wc -l <"$folder/log")" = 1 ] || fail "more than one line without a display"
grep -q -- '--headless' "$folder/log" || fail "does not name --headless"

# No OpenGL on the display: drawn in memory and copied.
SDL_VIDEODRIVER=dummy "$probe" once >"$folder/log" 2>&1 || fail "failed on the dummy driver"
grep -q 'shown 320 x 180' "$folder/log" || fail "showed nothing on the dummy driver"

# A virtual display with OpenGL.
start_virtual_display "$folder" 800x600 || fail "Xvfb did not start"
"$probe" >"$folder/log" 2>&1 &
pid=$!
expect() { for _ in $(seq 300); do grep -q "$1" "$folder/log" && return; sleep 0.1; done; fail "no '$1'"; }
expect 'shown 320 x 180'
# What the program has drawn may be with the X server before the window's name is.
window=$(timeout 30 xdotool search --sync --onlyvisible --name 'window probe' | head -1) || fail "no window has the name"
for _ in $(seq 100); do  # ... and so may be the picture
  import -window "$window" "$folder/shown.png"
  colours=$(identify -format %k "$folder/shown.png")
  [ "$colours" -gt 1000 ] && break
  sleep 0.1
done
[ "$colours" -gt 1000 ] || fail "the window shows $colours colours, not the scene"
xdotool windowfocus "$window" mousemove --window "$window" 100 50 click 1 key a
expect 'click 100 50'
expect 'key A'
xdotool windowsize "$window" 400 300
expect 'shown 400 x 300'
xdotool key Escape
expect 'closed'
wait "$pid" || fail "ended with status $?"
