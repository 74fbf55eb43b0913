.syntax unified
.thumb

.section .vectors, "a", %progbits
.type vectors, %object
vectors:
    .word stack_top
    .word reset_handler
    .word spin                  @ NMI
    .word hard_fault_handler
    .word spin, spin, spin      @ memory management, bus and usage faults
    .word 0, 0, 0, 0
    .word spin                  @ SVC
    .word 0, 0
    .word spin                  @ PendSV
    .word systick_handler
/* VECTORS */.size vectors, . - vectors

.section .text.reset_handler, "ax", %progbits
.global reset_handler
.type reset_handler, %function
.thumb_func
reset_handler:
/* FPU */    ldr r0, =data_start
    ldr r1, =data_end
    ldr r2, =data_image
1:  cmp r0, r1
    bhs 2f
    ldm r2!, {r3}
    stm r0!, {r3}
    b 1b
2:  ldr r0, =bss_start
    ldr r1, =bss_end
    movs r2, #0
3:  cmp r0, r1
    bhs 4f
    stm r0!, {r2}
    b 3b
4:  bl main
    b spin
.ltorg
.size reset_handler, . - reset_handler

.type spin, %function
.thumb_func
spin:
    b spin
.size spin, . - spin

.type hard_fault_handler, %function
.thumb_func
hard_fault_handler:
    mrs r0, msp
    ldr r1, =hard_fault
    bx r1
.ltorg
.size hard_fault_handler, . - hard_fault_handler
