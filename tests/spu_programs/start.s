# Start-up of the programs: a stack, main with the arguments that libspe2 gives in $3 to $5, and the end with stop 0x2000 + status.
	.text
	.global	_start
_start:
	ila	$1, 0x3FFC0
	il	$6, 0
	stqd	$6, 0($1)		# no caller
	brsl	$0, main
	br	exit

# A check has failed: its number is in $79.
	.global	fail
fail:
	ori	$3, $79, 0

# One `stop` for each status, because the code is a part of the instruction.
exit:
	andi	$3, $3, 63
	shli	$3, $3, 2
	ila	$4, stops
	a	$4, $4, $3
	bi	$4
stops:
	.set	status, 0
	.rept	64
	stop	0x2000 + status
	.set	status, status + 1
	.endr
