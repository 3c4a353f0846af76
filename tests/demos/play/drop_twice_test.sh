#!/usr/bin/env bash
# Two models that are dropped in the same place during a pause are above each other, by at least a quarter of their size.
source "$(dirname "$0")/play.sh"

make_tetrahedron
start 3d --scene drop --json "$folder/drop.json"
sleep 1
xdotool key p
sleep 0.3
for _ in 1 2; do drop 320 220 "$folder/tetrahedron.obj"; sleep 1; done
shot demo3d_dropped_twice
xdotool key F5
sleep 0.7
finish
grep -q '"bodies": 3' drop.json || fail "two models are dropped, and there are $(grep bodies drop.json)"
sed -n 's/^position = \[\(.*\)\]/\1/p' drop_1.toml | tail -2 | tr -d , | awk '{ y[NR] = $2 } END { exit NR == 2 && y[2] - y[1] > 0.1 ? 0 : 1 }' ||
  fail "a dropped model begins inside another: $(grep position drop_1.toml)"
