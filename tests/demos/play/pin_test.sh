#!/usr/bin/env bash
# H pins what the mouse holds, and takes the pin off when it holds nothing; the replay does, too.
source "$(dirname "$0")/play.sh"

start 2d --scene man --record "$folder/pin.rec"
xdotool mousemove --window "$window" 320 160 mousedown 1
sleep 0.2
xdotool mousemove --window "$window" 360 120
sleep 0.3
xdotool key h
sleep 0.1
xdotool mouseup 1
sleep 0.7
shot demo2d_pinned
xdotool key h
sleep 0.3
finish
recorded 'pin user' pin
recorded 'unpin all' pin
same_again 2d pin

# In three dimensions, too; and where bodies touch with spheres, the window says that they cannot be pinned.
for contacts in surface spheres; do
  start 3d --scene drop --contacts $contacts --record "$folder/$contacts.rec"
  sleep 2
  xdotool mousemove --window "$window" 320 255 mousedown 1
  sleep 0.3
  xdotool mousemove --window "$window" 320 150
  sleep 0.5
  xdotool key h
  sleep 0.3
  shot demo3d_pin_$contacts
  xdotool mouseup 1
  sleep 0.7
  shot demo3d_let_go_$contacts
  finish
  [ $contacts = spheres ] || same_again 3d surface
  recorded 'pin user' $contacts
done
"$softcell" demo 3d --replay "$folder/spheres.rec" --contacts spheres --headless >"$folder/log" 2>&1 || fail "the replay with spheres fails"
