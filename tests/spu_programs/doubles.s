# Double precision: a series with one rounding a step, the four rounding modes, flags, conversions.
	.include "program.inc"
	.text
	.global	main
main:
	il	$10, 0
	fscrwr	$10			# nearest, no flags
# 1: the exponential of 1 and of 0.7 by 18 terms, each step rounded once: the very bits.
	ila	$11, coefficients
	ila	$12, arguments
	lqd	$13, 0($12)
	lqd	$14, 0($11)
	il	$15, 17
horner:
	ai	$11, $11, 16
	lqd	$16, 0($11)
	dfma	$16, $14, $13		# $16 = $14 * $13 + $16
	ori	$14, $16, 0
	ai	$15, $15, -1
	brnz	$15, horner
	lqd	$16, 16($12)
	expect_same $14, $16, 1

# 2: 1 + 2^-54 and -1 - 2^-54 in each mode, the same in both lanes.
	il	$15, 0			# the mode
	ila	$17, rounded
modes:
	shli	$18, $15, 10
	shli	$19, $15, 8
	or	$18, $18, $19
	fsmbi	$27, 0xF000		# in the other words there are flags at these bits
	and	$18, $18, $27
	fscrwr	$18
	lqd	$20, 32($12)		# 1, -1
	lqd	$21, 48($12)		# 2^-54, -2^-54
	dfa	$22, $20, $21
	lqd	$23, 0($17)
	expect_same $22, $23, 2
	fscrrd	$24
	rotqbyi	$25, $24, 4
	expect	$25, 0x00000800, 3	# inexact, in the left lane
	rotqbyi	$25, $24, 8
	expect	$25, 0x00000800, 4	# and in the right one
	ai	$17, $17, 16
	ai	$15, $15, 1
	ceqi	$26, $15, 4
	brz	$26, modes

# 5: each lane has a mode of its own: up in the left, down in the right one.
	il	$18, 0x0B00
	and	$18, $18, $27
	fscrwr	$18
	dfa	$22, $20, $21
	lqd	$23, 64($12)
	expect_same $22, $23, 5

# 6: a * b - c, its negative, and -(a * b + c), of numbers that cancel.
	il	$10, 0
	fscrwr	$10
	lqd	$30, 80($12)		# 3, 5
	lqd	$31, 96($12)		# 7, 0.2
	lqd	$32, 112($12)		# 21, 1
	ori	$33, $32, 0
	dfms	$33, $30, $31
	lqd	$34, 128($12)
	expect_same $33, $34, 6
	ori	$33, $32, 0
	dfnms	$33, $30, $31
	lqd	$34, 144($12)
	expect_same $33, $34, 7
	ori	$33, $32, 0
	dfnma	$33, $30, $31
	lqd	$34, 160($12)
	expect_same $33, $34, 8

# 9: to single and back; an infinity; a NaN.
	lqd	$30, 16($12)
	frds	$31, $30
	fesd	$32, $31
	frds	$33, $32
	expect_same $31, $33, 9
	constant $30, 0x7FEFFFFF
	dfm	$31, $30, $30
	expect	$31, 0x7FF00000, 10
	dfs	$31, $31, $31
	expect	$31, 0x7FF80000, 11
	fscrrd	$24
	rotqbyi	$25, $24, 4
	constant $26, 0x00002000	# overflow, among others
	and	$25, $25, $26
	expect	$25, 0x00002000, 12
	il	$3, 0
	bi	$0

	.section .rodata
	.align	4
coefficients:
	.long	0x3CE952C7, 0x7030AD4A, 0x3CE952C7, 0x7030AD4A
	.long	0x3D2AE7F3, 0xE733B81F, 0x3D2AE7F3, 0xE733B81F
	.long	0x3D6AE7F3, 0xE733B81F, 0x3D6AE7F3, 0xE733B81F
	.long	0x3DA93974, 0xA8C07C9D, 0x3DA93974, 0xA8C07C9D
	.long	0x3DE61246, 0x13A86D09, 0x3DE61246, 0x13A86D09
	.long	0x3E21EED8, 0xEFF8D898, 0x3E21EED8, 0xEFF8D898
	.long	0x3E5AE645, 0x67F544E4, 0x3E5AE645, 0x67F544E4
	.long	0x3E927E4F, 0xB7789F5C, 0x3E927E4F, 0xB7789F5C
	.long	0x3EC71DE3, 0xA556C734, 0x3EC71DE3, 0xA556C734
	.long	0x3EFA01A0, 0x1A01A01A, 0x3EFA01A0, 0x1A01A01A
	.long	0x3F2A01A0, 0x1A01A01A, 0x3F2A01A0, 0x1A01A01A
	.long	0x3F56C16C, 0x16C16C17, 0x3F56C16C, 0x16C16C17
	.long	0x3F811111, 0x11111111, 0x3F811111, 0x11111111
	.long	0x3FA55555, 0x55555555, 0x3FA55555, 0x55555555
	.long	0x3FC55555, 0x55555555, 0x3FC55555, 0x55555555
	.long	0x3FE00000, 0x00000000, 0x3FE00000, 0x00000000
	.long	0x3FF00000, 0x00000000, 0x3FF00000, 0x00000000
	.long	0x3FF00000, 0x00000000, 0x3FF00000, 0x00000000
arguments:
	.long	0x3FF00000, 0x00000000, 0x3FE66666, 0x66666666
	.long	0x4005BF0A, 0x8B145769, 0x40001C2A, 0x61268987
	.long	0x3FF00000, 0x00000000, 0xBFF00000, 0x00000000
	.long	0x3C900000, 0x00000000, 0xBC900000, 0x00000000
	.long	0x3FF00000, 0x00000001, 0xBFF00000, 0x00000001
	.long	0x40080000, 0x00000000, 0x40140000, 0x00000000
	.long	0x401C0000, 0x00000000, 0x3FC99999, 0x9999999A
	.long	0x40350000, 0x00000000, 0x3FF00000, 0x00000000
	.long	0x00000000, 0x00000000, 0x3C900000, 0x00000000
	.long	0x80000000, 0x00000000, 0xBC900000, 0x00000000
	.long	0xC0450000, 0x00000000, 0xC0000000, 0x00000000
rounded:
	.long	0x3FF00000, 0x00000000, 0xBFF00000, 0x00000000
	.long	0x3FF00000, 0x00000000, 0xBFF00000, 0x00000000
	.long	0x3FF00000, 0x00000001, 0xBFF00000, 0x00000000
	.long	0x3FF00000, 0x00000000, 0xBFF00000, 0x00000001
