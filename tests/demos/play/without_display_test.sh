#!/usr/bin/env bash
# No display: one sentence, the way out, status 1.
source "$(dirname "$0")/play.sh"

for demo in 2d 3d; do
  status=0
  env -u DISPLAY -u WAYLAND_DISPLAY -u SDL_VIDEODRIVER "$softcell" demo $demo >"$folder/log" 2>&1 || status=$?
  [ "$status" = 1 ] || fail "demo $demo ends with status $status without a display"
  [ "$(wc -l <"$folder/log")" = 1 ] || fail "demo $demo says more than one line without a display"
  grep -q -- '--headless' "$folder/log" || fail "demo $demo does not name --headless"
done

# Pictures are for runs without a window.
status=0
"$softcell" demo 2d --out "$folder/frames" >"$folder/log" 2>&1 || status=$?
[ "$status" = 2 ] && grep -q -- '--headless' "$folder/log" || fail "a window accepts --out"

# No OpenGL on the display: drawn in memory and copied.
SDL_VIDEODRIVER=dummy "$softcell" demo 2d --frames 5 >"$folder/log" 2>&1 || fail "fails on the dummy driver"
grep -q '5 frames' "$folder/log" || fail "does not end after --frames"
