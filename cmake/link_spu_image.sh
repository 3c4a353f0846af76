#!/bin/sh
# link_spu_image.sh KERNEL IMAGE BEGIN STACK_BYTES BUDGET_BYTES CMAKE NM LINKER ARGUMENT...
# Links a kernel for the host. ls.ld refuses an image that passes its budget, but cannot say by how much: then this links it without a
# budget and has CheckSpuBudget.cmake say so. (It is asked after a mistake only: a build links hundreds of images.)
kernel=$1 image=$2 begin=$3 stack_bytes=$4 budget_bytes=$5 cmake=$6 nm=$7
shift 7
"$@" -o "$image" --defsym softcell_budget_bytes="$budget_bytes" && exit 0
"$@" -o "$image" --defsym softcell_budget_bytes=0x7fffffff 2>/dev/null &&
  "$cmake" -DNM="$nm" -DIMAGE="$image" -DKERNEL="$kernel" -DBEGIN="$begin" -DSTACK_BYTES="$stack_bytes" \
    -DBUDGET_BYTES="$budget_bytes" -P "$(dirname "$0")/CheckSpuBudget.cmake"
rm -f "$image"
exit 1
