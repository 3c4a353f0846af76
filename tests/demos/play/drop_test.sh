#!/usr/bin/env bash
# A model that is dropped onto the window becomes a soft body there; what is none is refused in a sentence, and the scene goes on; a scene is
# opened. Delete removes the body that was held last.
source "$(dirname "$0")/play.sh"

make_tetrahedron
echo rubbish >rubbish.ply
printf '[framework]\n[[soft_body]]\ncell_size = 0.25\nshape = { kind = "sphere" }\nposition = [0, 1, 0]\n' >mine.toml
start 3d --scene drop --json "$folder/drop.json"
drop 320 150 "$folder/tetrahedron.obj"
sleep 1.5
shot demo3d_dropped
drop 320 150 "$folder/rubbish.ply"
sleep 0.7
shot demo3d_dropped_rubbish
finish
grep -q '"bodies": 2' drop.json || fail "the dropped model is no second body: $(grep bodies drop.json)"
start 3d --scene drop --json "$folder/drop.json"
drop 320 150 "$folder/mine.toml"
sleep 1.5
xdotool mousemove --window "$window" 320 200 mousedown 1
sleep 0.3
xdotool mouseup 1 key Delete
sleep 1
shot demo3d_deleted
finish
grep -q '"scene": "mine"' drop.json || fail "the dropped scene is not opened: $(grep scene drop.json)"
grep -q '"bodies": 0' drop.json || fail "Delete does not remove the body that was held: $(grep bodies drop.json)"
