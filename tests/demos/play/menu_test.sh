#!/usr/bin/env bash
# The menu: by keyboard alone, a pause and slow motion; with the mouse, another gravity, which the scene under it does not notice.
source "$(dirname "$0")/play.sh"

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
