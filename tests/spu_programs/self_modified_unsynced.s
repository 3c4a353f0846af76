# Code that writes code and runs it without a `sync`. A real SPU may have fetched the old instruction already, so either result is right: the
# status is 1 for the old one and 2 for the new one. A checker should say that a `sync` is missing.
	.include "program.inc"
	.text
	.global	main
main:
	ila	$13, patched
	ilhu	$15, 0x4080		# il $3, 2
	iohl	$15, 0x0103
	store_word $15, $13
patched:
	il	$3, 1
	bi	$0
