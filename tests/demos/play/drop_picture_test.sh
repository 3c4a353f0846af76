#!/usr/bin/env bash
# In two dimensions a picture does.
source "$(dirname "$0")/play.sh"

convert -size 120x100 xc:none -fill red -draw 'circle 60,50 60,90' cat.png
start 2d --json "$folder/drop.json"
drop 150 100 "$folder/cat.png"
sleep 1
shot demo2d_dropped
finish
grep -q '"bodies": 2' drop.json || fail "the dropped picture is no second body: $(grep bodies drop.json)"

# A recording belongs to one scene.
start 2d --record "$folder/one.rec" --json "$folder/drop.json"
drop 150 100 "$folder/cat.png"
sleep 0.7
shot demo2d_drop_refused
finish
grep -q '"bodies": 1' drop.json || fail "a drop changes a scene that is recorded"
same_again 2d one
