# What runs before and after main in an executable that softcell_add_spu_kernel makes for the SPU. A job loop calls main without it.
#
# $3 to $6 are main's arguments, as libspe2 and lv2 leave them. The stack begins where ls.ld says. main's result ends the program by
# "stop 0x2000 + (result & 255)", an instruction that is built in memory, because its code is an immediate.  [libspe2, newlib] second-hand
	.section .text.softcell_start, "ax"
	.align	4
	.global	_start
	.type	_start, @function
_start:
	lqr	$1, softcell_initial_stack
	il	$7, 0
	stqd	$7, 0($1)		# the outermost back chain
	brsl	$0, softcell_main
	andi	$3, $3, 0xff
	ila	$4, 0x2000
	or	$3, $3, $4		# the opcode of stop is 0
	cwd	$6, 0($1)
	lqr	$7, .Lending
	shufb	$7, $3, $7, $6
	stqr	$7, .Lending
	sync
.Lending:
	stop	0			# replaced
	nop
	lnop
	nop
	.size	_start, .-_start

# What the compiler makes of __builtin_trap().
	.weak	abort
	.type	abort, @function
abort:
	heq	$2, $2
	.size	abort, .-abort

	.section .rodata.softcell_start, "a"
	.align	4
softcell_initial_stack:
	.long	softcell_stack_pointer, softcell_stack_left, 0, 0
