#!/usr/bin/env bash
# The list of scenes has a picture of each; the arrow keys and Space play one, also a scene file of the present folder.
source "$(dirname "$0")/play.sh"

mkdir "$folder/own"
cd "$folder/own"
printf 'title = "one ball"\n[framework]\n[[soft_body]]\ncell_size = 0.25\nshape = { kind = "sphere" }\nposition = [0, 1, 0]\n' >my_ball.toml
for downs in 1 4; do  # from the heading to my_ball; past it, drop and arena to big
  start 3d --scene drop --json "$folder/chosen.json"
  xdotool key m
  sleep 0.7
  shot "demo3d_scenes_$downs"
  for _ in $(seq "$downs"); do xdotool key Down; sleep 0.2; done
  xdotool key space
  sleep 2.5
  shot "demo3d_chosen_$downs"
  leave
  expected=$([ "$downs" = 1 ] && echo my_ball || echo big)
  grep -q "\"scene\": \"$expected\"" "$folder/chosen.json" || fail "the keys choose $(grep '"scene"' "$folder/chosen.json"), not $expected"
done
