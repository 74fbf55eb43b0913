@ The second stage of the boot ROM of an RP2040 (data sheet §2.8.1.3.1): it lets flash be read at its addresses, with the
@ serial read 03h that every flash knows, at a fourth of the clock (BAUDR), and starts the image. Called again, it returns.
@ `BOOT2` in src/image/boot2.rs is what this is in machine code; a test assembles and compares it.
.syntax unified
.cpu cortex-m0plus
.thumb
    ldr r3, =0x18000000         @ SSI
    movs r1, #0
    str r1, [r3, #0x08]         @ SSIENR: off
    movs r1, #4
    str r1, [r3, #0x14]         @ BAUDR
    ldr r1, =0x001F0300         @ 32 bits a frame, a command and what comes back
    str r1, [r3, #0x00]         @ CTRLR0
    ldr r1, =0x03000218         @ read command 03h, 8 bits; address of 24 bits; one line
    ldr r2, =0x180000F4
    str r1, [r2]                @ SPI_CTRLR0
    movs r1, #0
    str r1, [r3, #0x04]         @ CTRLR1: one frame
    movs r1, #1
    str r1, [r3, #0x08]         @ SSIENR: on
    mov r0, lr
    cmp r0, #0
    bne 1f
    ldr r0, =0x10000100         @ the image's vectors
    ldr r1, =0xE000ED08
    str r0, [r1]                @ VTOR
    ldm r0!, {r2, r3}
    msr msp, r2
    bx r3
1:  bx r0
.align 2
.ltorg
