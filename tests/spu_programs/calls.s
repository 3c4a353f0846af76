# Calls: recursion with frames as the ABI has them, functions from a table, arguments that need all 128 bits.
	.include "program.inc"
	.text
	.global	main
main:
	stqd	$0, 16($1)
	stqd	$1, -32($1)
	ai	$1, $1, -32

# 1: Fibonacci, two calls deep in each.
	il	$3, 15
	brsl	$0, fibonacci
	expect	$3, 610, 1
# 2: Ackermann, which needs a deep stack.
	il	$3, 2
	il	$4, 6
	brsl	$0, ackermann
	expect	$3, 15, 2
# 3: the stack is where it was.
	ila	$10, 0x3FFC0 - 32
	expect_same $1, $10, 3
# 4: each function of a table, by its address.
	il	$80, 0
	il	$3, 10
next_function:
	ila	$10, functions
	a	$10, $10, $80
	load_word $11, $10
	bisl	$0, $11
	ai	$80, $80, 4
	ceqi	$10, $80, 16
	brz	$10, next_function
	expect	$3, ((10 + 5) * 4 - 1) * -1, 4
# 5: a call through the register that receives the link.
	ila	$0, plus_five
	bisl	$0, $0
	expect	$3, -54, 5

	il	$3, 0
	ai	$1, $1, 32
	lqd	$0, 16($1)
	bi	$0

# $3 = Fibonacci number $3.
fibonacci:
	cgti	$4, $3, 1
	brz	$4, fibonacci_end
	stqd	$0, 16($1)
	stqd	$80, -16($1)
	stqd	$81, -32($1)
	stqd	$1, -64($1)
	ai	$1, $1, -64
	ori	$80, $3, 0
	ai	$3, $3, -1
	brsl	$0, fibonacci
	ori	$81, $3, 0
	ai	$3, $80, -2
	brsl	$0, fibonacci
	a	$3, $3, $81
	ai	$1, $1, 64
	lqd	$0, 16($1)
	lqd	$80, -16($1)
	lqd	$81, -32($1)
fibonacci_end:
	bi	$0

# $3 = A($3, $4).
ackermann:
	brnz	$3, ackermann_m
	ai	$3, $4, 1
	bi	$0
ackermann_m:
	stqd	$0, 16($1)
	stqd	$80, -16($1)
	stqd	$1, -48($1)
	ai	$1, $1, -48
	ai	$80, $3, -1
	brnz	$4, ackermann_n
	ori	$3, $80, 0
	il	$4, 1
	brsl	$0, ackermann
	br	ackermann_end
ackermann_n:
	ai	$4, $4, -1
	brsl	$0, ackermann
	ori	$4, $3, 0
	ori	$3, $80, 0
	brsl	$0, ackermann
ackermann_end:
	ai	$1, $1, 48
	lqd	$0, 16($1)
	lqd	$80, -16($1)
	bi	$0

plus_five:
	ai	$3, $3, 5
	bi	$0
times_four:
	shli	$3, $3, 2
	bi	$0
minus_one:
	ai	$3, $3, -1
	bi	$0
negated:
	sfi	$3, $3, 0
	bi	$0

	.section .rodata
	.align	4
functions:
	.int	plus_five, times_four, minus_one, negated
