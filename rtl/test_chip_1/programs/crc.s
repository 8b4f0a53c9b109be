# CRC-32 of IEEE 802.3 (zlib's) of the `length` bytes at `address`, to the host
li a0, address
li a1, length
add a1, a0, a1
li a2, 0xedb88320
li a3, -1
beq a0, a1, end
octet: lbu a4, 0(a0)
addi a0, a0, 1
xor a3, a3, a4
li a5, 8
bit: andi a6, a3, 1
neg a6, a6
and a6, a6, a2
srli a3, a3, 1
xor a3, a3, a6
addi a5, a5, -1
bnez a5, bit
bne a0, a1, octet
end: not a3, a3
csrw 0x7c0, a3
ebreak
