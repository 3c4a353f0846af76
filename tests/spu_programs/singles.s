# Single precision as kernels use it: estimates with a Newton step, a dot product, a matrix turned by shuffles, conversions.
	.include "program.inc"
	.text
	.global	main
main:
	il	$10, 8
	ila	$11, numbers
	constant $20, 0x3F800000	# 1
	constant $21, 0x40000000	# 2
	constant $22, 0x34800000	# 2^-22
	constant $23, 0x3F000000	# 1/2
	il	$24, 0
next:
	lqd	$12, 0($11)
# 1: y = y (2 - x y), then x y is 1 but for 2^-22.
	frest	$13, $12
	fi	$13, $12, $13
	fnms	$14, $12, $13, $21
	fm	$13, $13, $14
	fnms	$14, $12, $13, $20
	fcmgt	$15, $14, $22
	expect_same $15, $24, 1
# 2: y = y + y/2 (1 - x y y), then x y y is 1 but for 2^-21.
	frsqest	$13, $12
	fi	$13, $12, $13
	fm	$16, $13, $13
	fnms	$14, $12, $16, $20
	fm	$17, $13, $23
	fma	$13, $17, $14, $13
	fm	$16, $13, $13
	fnms	$14, $12, $16, $20
	fa	$25, $22, $22
	fcmgt	$15, $14, $25
	expect_same $15, $24, 2
# 3: through integers and back, in eighths.
	cflts	$13, $12, 3
	csflt	$14, $13, 3
	fs	$14, $12, $14
	constant $15, 0x3E000000	# 1/8
	fcmgt	$15, $14, $15
	expect_same $15, $24, 3
	ai	$11, $11, 16
	ai	$10, $10, -1
	brnz	$10, next

# 4: the sum of the 32 products of what are small integers: exact.
	il	$10, 8
	ila	$11, integers
	il	$12, 0
products:
	lqd	$13, 0($11)
	fma	$12, $13, $13, $12
	ai	$11, $11, 16
	ai	$10, $10, -1
	brnz	$10, products
	rotqbyi	$13, $12, 8
	fa	$12, $12, $13
	rotqbyi	$13, $12, 4
	fa	$12, $12, $13
	expect	$12, 0x4632C000, 4
# 5: a 4 by 4 matrix turned twice is itself; once, its first column is its first row.
	ila	$11, numbers
	lqd	$30, 0($11)
	lqd	$31, 16($11)
	lqd	$32, 32($11)
	lqd	$33, 48($11)
	brsl	$2, transpose
	lqd	$50, 64($11)		# nothing that the transpose uses
	load_word $51, $11
	constant $52, 0
	ai	$53, $11, 16
	load_word $54, $53
	cwd	$55, 4($52)
	shufb	$56, $54, $51, $55
	ai	$53, $11, 32
	load_word $54, $53
	cwd	$55, 8($52)
	shufb	$56, $54, $56, $55
	ai	$53, $11, 48
	load_word $54, $53
	cwd	$55, 12($52)
	shufb	$56, $54, $56, $55
	expect_same $56, $30, 5
	brsl	$2, transpose
	lqd	$57, 48($11)
	expect_same $57, $33, 6
	il	$3, 0
	bi	$0

# Rows $30 to $33 become columns. Link in $2.
transpose:
	ila	$40, interleave_left
	lqd	$41, 0($40)
	lqd	$42, 16($40)
	shufb	$34, $30, $32, $41
	shufb	$35, $31, $33, $41
	shufb	$36, $30, $32, $42
	shufb	$37, $31, $33, $42
	shufb	$30, $34, $35, $41
	shufb	$31, $34, $35, $42
	shufb	$32, $36, $37, $41
	shufb	$33, $36, $37, $42
	bi	$2

	.section .rodata
	.align	4
interleave_left:
	.int	0x00010203, 0x10111213, 0x04050607, 0x14151617
	.int	0x08090A0B, 0x18191A1B, 0x0C0D0E0F, 0x1C1D1E1F
numbers:
	.float	1, 2, 3, 0.5, 10, 7, 0.1, 100.25
	.float	3.14159, 2.71828, 1000, 0.001, 65536.5, 12345.678, 0.333, 1.9999
	.float	42, 8191, 1.5, 0.75, 31.4, 4.2, 5.1, 6.6
	.float	9.9, 99.9, 999.9, 0.25, 11, 13, 17, 19
integers:
	.float	1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16
	.float	17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32
