# Reads a count from the inbound mailbox, then so many words, answers each by the sum so far, and gives the last sum to the interrupting
# mailbox. The counts of the channels must say what is there.
	.include "program.inc"
	.text
	.global	main
main:
	rchcnt	$20, $ch28		# room for one word
	expect	$20, 1, 1
	rdch	$10, $ch29
	il	$11, 0
next:
	rdch	$12, $ch29
	a	$11, $11, $12
	wrch	$ch28, $11		# waits while the last answer was not read
	ai	$10, $10, -1
	brnz	$10, next
	rchcnt	$20, $ch29		# nothing is left
	expect	$20, 0, 2
	wrch	$ch30, $11
	rdch	$20, $ch13		# interrupts were never enabled
	expect	$20, 0, 3
	il	$3, 0
	bi	$0
