#!/usr/bin/env bash
# F5 saves what there is; the saved scene opens with a body as high as it was.
source "$(dirname "$0")/play.sh"

start 3d --scene drop
sleep 1
xdotool key p
sleep 0.3
xdotool key F5
sleep 0.7
shot demo3d_saved
[ -s drop_1.toml ] && [ -s drop_1.state ] || fail "F5 saves no scene"
finish
"$softcell" demo 3d --headless --scene drop_1.toml --frames 1 --quiet || fail "the saved scene cannot be played"
grep -q '^gravity' drop_1.toml || fail "the saved scene has no gravity: $(cat drop_1.toml)"
