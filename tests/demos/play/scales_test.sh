#!/usr/bin/env bash
# Dense displays: text and menu grow with the scale; the bar over the menu ends where its width says.
source "$(dirname "$0")/play.sh"

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
