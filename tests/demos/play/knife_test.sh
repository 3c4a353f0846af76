#!/usr/bin/env bash
# The knife: a line over the body cuts it, and the replay does, too.
source "$(dirname "$0")/play.sh"

start 3d --scene drop --record "$folder/cut.rec" --json "$folder/cut.json"
sleep 1
xdotool key k
xdotool mousemove --window "$window" 320 30 mousedown 1
for y in 100 200 300; do xdotool mousemove --window "$window" 320 $y; sleep 0.1; done
sleep 0.3
shot demo3d_stroke
xdotool mousemove --window "$window" 320 350 mouseup 1
sleep 0.7
shot demo3d_cut
finish
recorded 'cut all' cut
! grep -q hold "$folder/cut.rec" || fail "a hand takes what the knife cuts"
grep -q '"bodies": 2' "$folder/cut.json" || fail "the knife leaves $(grep '"bodies"' "$folder/cut.json")"
same_again 3d cut

# Where bodies touch with spheres there is no knife, and the window says so.
start 3d --scene drop --contacts spheres --record "$folder/no_cut.rec"
xdotool key k
sleep 0.5
shot demo3d_no_knife
xdotool mousemove --window "$window" 320 30 mousedown 1 mousemove --window "$window" 320 300 mouseup 1
sleep 0.3
finish
! grep -q cut "$folder/no_cut.rec" || fail "the knife cuts bodies that touch with spheres"
