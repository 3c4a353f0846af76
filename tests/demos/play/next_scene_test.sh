#!/usr/bin/env bash
# On to the next scene, in a window of another size.
source "$(dirname "$0")/play.sh"

size=400x300 start 3d
xdotool key n
sleep 1.5
xdotool windowsize "$window" 500 400
sleep 0.5
shot demo3d_next
[ "$(identify -format %wx%h "$shots/demo3d_next.png")" = 500x400 ] || fail "the picture does not follow the window's size"
finish
! grep -q '^scene:  *arena:' "$folder/log" || fail "the next scene is the first again"
