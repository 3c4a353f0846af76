#!/usr/bin/env bash
# The demos' windows under a virtual X server, with a real mouse and keys: what the user does is in the recording, and the replay
# ends in the same state, in a window and without. Without a display they say so in one sentence.
#   play_test.sh SOFTCELL DROP_FILE [FOLDER FOR SCREENSHOTS]
set -euo pipefail
source "$(dirname "$0")/../../ci/virtual-display"
softcell=$(realpath "$1")
drop_file=$(realpath "$2")
folder=$(mktemp -d)
shots=$(realpath "${3:-$folder}")
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$folder"' EXIT
fail() { echo "play_test: $*" >&2; sed 's/^/softcell: /' "$folder"/log >&2 || true; exit 1; }

# No display: one sentence, the way out, status 1.
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

start_virtual_display "$folder" 1400x800 || fail "Xvfb did not start"

# start VERB OPTIONS...: runs softcell and waits for its window. It is small, as the processor draws its pixels; `size=1280x720 start` has a
# larger one.
start() {
  "$softcell" demo "$1" --size "${size:-640x360}" "${@:2}" >"$folder/log" 2>&1 &
  pid=$!
  window=$(timeout 60 xdotool search --sync --onlyvisible --name "softcell demo $1" | head -1) || fail "no window"
  xdotool windowfocus --sync "$window"
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
  for how in --headless --size=640x360; do
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

# Two dimensions: grab the man, drag him, throw him; gravity; views; help.
start 2d --record "$folder/play.rec"
xdotool mousemove --window "$window" 320 180 mousedown 1
for x in 350 380 410 440; do xdotool mousemove --window "$window" $x 100; sleep 0.1; done
shot demo2d_dragged
xdotool mouseup 1 key Up key plus key space
sleep 0.3
xdotool key v key F1
sleep 0.5
shot demo2d_help
finish
for event in 'hold user 0' 'move user' 'release user' 'gravity 0 9' 'gravity 0 10' 'push all 0 5'; do recorded "$event" play; done
same_again 2d play

# Three dimensions: tilt, jump, look from elsewhere, back to the beginning.
start 3d --record "$folder/play3.rec"
shot demo3d_begin  # a key that is released before the first frame tilts nothing
xdotool keydown Right
sleep 2  # the tilt grows to its limit in a fifth of it, on a machine that keeps up
xdotool keyup Right key space
xdotool mousemove --window "$window" 320 180 mousedown 1 mousemove --window "$window" 400 165 mouseup 1
sleep 0.7
shot demo3d_tilted
xdotool key BackSpace key p
finish
for event in 'tilt 0 0 -0.35' 'push all 0 5 0' 'home all' 'pause'; do recorded "$event" play3; done
same_again 3d play3

# The mouse takes a body in three dimensions, lifts it, moves it away with the wheel, and throws it.
start 3d --scene drop --record "$folder/hold.rec"
shot demo3d_drop
sleep 1
xdotool mousemove --window "$window" 320 210 mousedown 1
for y in 190 165 140 120; do xdotool mousemove --window "$window" 320 $y; sleep 0.1; done
xdotool click 4
sleep 0.5
shot demo3d_held
xdotool mousemove --window "$window" 250 100 mouseup 1
sleep 0.2
finish
for event in 'hold user 0' 'move user' 'release user'; do recorded "$event" hold; done
same_again 3d hold

# The knife: a line over the body cuts it, and the replay does, too.
start 3d --scene drop --record "$folder/cut.rec" --json "$folder/cut.json"
shot demo3d_before_cut
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

# In the view of contacts a click on a point takes nothing, and the menu has the contact's values.
size=1280x720 start 3d --scene drop --view contacts --record "$folder/contact.rec"
shot demo3d_contacts
sleep 2
xdotool key p
sleep 0.5
# The points are red, some pixels wide: the middle of one.
import -window "$window" -depth 8 "txt:$folder/contacts"
at=$(sed -n 's/^\([0-9]*\),\([0-9]*\): .*srgb(\([0-9]*\),\([0-9]*\),\([0-9]*\))/\1 \2 \3 \4 \5/p' "$folder/contacts" |
  awk '$3 > 150 && $4 < 60 && $5 < 60 { run = $2 == y && $1 == x + 1 ? run + 1 : 1; x = $1; y = $2; if (run > best) { best = run; bx = x - int(run / 2); by = y } }
       END { if (best >= 4) print bx, by }')
[ -n "$at" ] || fail "no contact is seen"
xdotool mousemove --window "$window" $at mousedown 1 mouseup 1
sleep 0.3
xdotool key m
sleep 0.7
xdotool mousemove --window "$window" 200 500
for _ in 1 2 3 4 5 6; do xdotool click 5; sleep 0.1; done
sleep 0.5
shot demo3d_contact_picked
convert "$shots/demo3d_contact_picked.png" -depth 8 txt:- | sed -n 's/^\([0-9]*\),[0-9]*: .*srgb(\([0-9]*\),\([0-9]*\),\([0-9]*\))/\1 \2 \3 \4/p' |
  awk '$1 > 410 && $2 > 170 && $3 > 110 && $4 < 80 { ++yellow } END { exit yellow > 20 ? 0 : 1 }' ||
  fail "the contact that was clicked is not marked"
xdotool key m
finish
! grep -q hold "$folder/contact.rec" || fail "a click on a contact takes a body"

# The menu: by keyboard alone, a pause and slow motion; with the mouse, another gravity, which the scene under it does not notice.
size=1280x720 start 3d --scene drop --record "$folder/menu.rec"
xdotool key m
sleep 0.5
shot demo3d_menu
for key in Down space Down space Left Escape; do xdotool key $key; sleep 0.2; done
xdotool mousemove --window "$window" 150 175 mousedown 1
sleep 0.2
xdotool mouseup 1
sleep 0.3
shot demo3d_menu_used
xdotool key m
sleep 0.3
finish
for event in pause 'time_scale 0' 'gravity 0 -'; do recorded "$event" menu; done
! grep -q 'hold\|tilt' "$folder/menu.rec" || fail "keys and mouse on the menu act on the scene: $(cat "$folder/menu.rec")"
same_again 3d menu

# The list of scenes has a picture of each; the arrow keys and Space play one, also a scene file of the present folder.
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
cd "$folder"

# Dense displays: text and menu grow with the scale; the bar over the menu ends where its width says.
for scale in 1 1.5 2; do
  size=1280x720 start 3d --scene drop --ui-scale $scale
  xdotool key F1
  sleep 0.7
  shot "demo3d_help_$scale"
  xdotool key F1 key k key Delete  # which nothing was held for: the window says so
  sleep 0.5
  shot "demo3d_knife_$scale"
  xdotool key k
  xdotool key m
  sleep 0.7
  shot "demo3d_scale_$scale"
  blue_at() { convert "$shots/demo3d_scale_$scale.png" -format "%[fx:100*p{int($1*$scale),int(20*$scale)}.b>100*p{int($1*$scale),int(20*$scale)}.r+20&&p{int($1*$scale),int(20*$scale)}.r<0.25?1:0]" info:; }
  [ "$(blue_at 300)" = 1 ] && [ "$(blue_at 412)" = 0 ] || fail "the menu is not as wide as scale $scale makes it"
  xdotool key m
  finish
done

# F5 saves what there is; the saved scene opens with a body as high as it was.
cd "$folder"
start 3d --scene drop
shot demo3d_drop_before
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

# A model that is dropped onto the window becomes a soft body there; what is none is refused in a sentence, and the scene goes on; a scene is
# opened. Delete removes the body that was held last.
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
echo rubbish >rubbish.ply
printf '[framework]\n[[soft_body]]\ncell_size = 0.25\nshape = { kind = "sphere" }\nposition = [0, 1, 0]\n' >mine.toml
drop() { "$drop_file" "$window" "$@" || fail "the window does not take $3"; }
start 3d --scene drop --json "$folder/drop.json"
shot demo3d_before_drop
drop 320 150 "$folder/tetrahedron.obj"
sleep 1.5
shot demo3d_dropped
drop 320 150 "$folder/rubbish.ply"
sleep 0.7
shot demo3d_dropped_rubbish
finish
grep -q '"bodies": 2' drop.json || fail "the dropped model is no second body: $(grep bodies drop.json)"
start 3d --scene drop --json "$folder/drop.json"
shot demo3d_before_drop
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

# Two models that are dropped in the same place during a pause are above each other, by at least a quarter of their size.
start 3d --scene drop --json "$folder/drop.json"
shot demo3d_before_drop
sleep 1
xdotool key p
sleep 0.3
for _ in 1 2; do drop 320 220 "$folder/tetrahedron.obj"; sleep 1; done
shot demo3d_dropped_twice
rm -f drop_*.toml drop_*.state
xdotool key F5
sleep 0.7
finish
grep -q '"bodies": 3' drop.json || fail "two models are dropped, and there are $(grep bodies drop.json)"
sed -n 's/^position = \[\(.*\)\]/\1/p' drop_1.toml | tail -2 | tr -d , | awk '{ y[NR] = $2 } END { exit NR == 2 && y[2] - y[1] > 0.1 ? 0 : 1 }' ||
  fail "a dropped model begins inside another: $(grep position drop_1.toml)"

# In two dimensions a picture does.
convert -size 120x100 xc:none -fill red -draw 'circle 60,50 60,90' cat.png
start 2d --json "$folder/drop.json"
shot demo2d_before_drop
drop 150 100 "$folder/cat.png"
sleep 1
shot demo2d_dropped
finish
grep -q '"bodies": 2' drop.json || fail "the dropped picture is no second body: $(grep bodies drop.json)"

# A recording belongs to one scene.
start 2d --record "$folder/one.rec" --json "$folder/drop.json"
shot demo2d_before_drop
drop 150 100 "$folder/cat.png"
sleep 0.7
shot demo2d_drop_refused
finish
grep -q '"bodies": 1' drop.json || fail "a drop changes a scene that is recorded"
same_again 2d one

# On to the next scene, in a window of another size.
size=400x300 start 3d
xdotool key n
sleep 1.5
xdotool windowsize "$window" 500 400
sleep 0.5
shot demo3d_next
[ "$(identify -format %wx%h "$shots/demo3d_next.png")" = 500x400 ] || fail "the picture does not follow the window's size"
finish
grep -q '^scene:  *arena:' "$folder/log" && fail "the next scene is the first again"

# Ctrl-C: one sentence says how far it came, and nothing half written is left.
start 2d --trace "$folder/t.json" --json "$folder/s.json"
kill -INT "$pid"
status=0
wait "$pid" || status=$?
[ "$status" = 130 ] || fail "ends with status $status when it is interrupted"
sentence='softcell: interrupted after [0-9]+ frames; only a run to its end leaves a trace, statistics or a saved scene'
grep -Eqx "$sentence" "$folder/log" && [ "$(wc -l <"$folder/log")" = 1 ] || fail "does not say how far it came"
ls "$folder" | grep -q '^[ts]\.json' && fail "an interrupted run leaves files"

# With a number of frames it closes by itself.
"$softcell" demo 2d --frames 30 --json "$folder/stats.json" >"$folder/log" 2>&1 || fail "fails with --frames"
grep -q '"frames": 30' "$folder/stats.json" || fail "not 30 frames"
