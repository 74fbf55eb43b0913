# no boot loader answers
# `rungc flash` waits for the boot loader that the vendor of the microcontroller put into its ROM. It runs only if the pin BOOT0 is high (and BOOT1, PB2 on STM32F1, low) while the part is reset, and only on certain UARTs: USART1 (PA9, PA10) on all STM32F1 and F0. Set the jumper or switch, reset the board or switch its supply off and on, and check that TX and RX are crossed. On boards with RS-232 the line needs RS-232 levels. The boot loader measures the bit rate once after a reset: after an attempt at another `--baud`, reset again. An answer that is not one of the protocol means that a program runs instead of the boot loader, or that the bit rate is wrong.
E0850 = 引导程序没有应答
    .text = `rungc flash` 等待单片机厂家写入 ROM 的引导程序（Bootloader）应答。只有在复位时引脚 BOOT0 为高电平（STM32F1 还要求 BOOT1 即 PB2 为低电平），引导程序才会运行，而且只使用某些 UART：所有 STM32F1 和 F0 都是 USART1（PA9、PA10）。设置跳线或开关，复位电路板或断电再上电，并检查 TX 与 RX 是否交叉连接。带 RS-232 的电路板，其线路需要 RS-232 电平。引导程序在复位后只测量一次比特率：用其他 `--baud` 试过之后，须重新复位。如果应答不符合协议，说明正在运行的是程序而不是引导程序，或者比特率不对。

# the part is not known or not the expected one
# The boot loader reports the product number of the part (AN2606), and `rungc flash` erases only parts whose pages it knows. Boards are sold with other microcontrollers than their documents say; parts of GigaDevice and Geehy (GD32F103, APM32F030) report the numbers of the STM32 that they replace and work. Parts of HDSC and Holtek (HC32, HT32) have other boot loaders and other registers: an image for an STM32 does not run on them.
E0851 = 芯片未知，或不是预期的芯片
    .text = 引导程序报告芯片的产品编号（AN2606），`rungc flash` 只擦除已知分页方式的芯片。市售电路板上的单片机常与资料不符；GigaDevice 和 Geehy 的芯片（GD32F103、APM32F030）报告它们所替代的 STM32 的编号，可以使用。HDSC 和 Holtek 的芯片（HC32、HT32）的引导程序和寄存器都不同：STM32 的固件映像不能在其上运行。

# the part is protected against reading or writing
# Firmware of vendors is usually read protected: only the vendor can restore it, and lifting the protection permanently erases all of flash, with the firmware and the PLC program in it. `rungc flash` does that only with `--unprotect`, and asks before; `--yes` alone does not allow it. If the boot loader rejects lifting the protection too, the part is locked for good (readout protection level 2 of an STM32F4 or F0), and no tool can write to it.
E0852 = 芯片有读保护或写保护
    .text = 厂家的固件通常有读保护：只有厂家能恢复它，而解除保护会永久擦除整个闪存，包括固件和其中的 PLC 程序。只有给出 `--unprotect`，`rungc flash` 才会解除保护，并事先询问；单独的 `--yes` 不允许解除。如果引导程序也拒绝解除保护，说明芯片已永久锁定（STM32F4 或 F0 的读保护级别 2），任何工具都无法写入。

# the image does not fit the flash of the part
# The addresses of an image come from `memory.flash` of the board's description. They have to be within the flash of the part that answers, whose size `rungc flash` reads from the part itself. Build the image for a description with the memory of your part; if it is too large for that, `rungc build --report` shows what takes space. Nothing has been erased.
E0853 = 固件映像与芯片的闪存不符
    .text = 固件映像的地址来自电路板描述中的 `memory.flash`，必须位于应答芯片的闪存之内；闪存的大小由 `rungc flash` 从芯片读出。按您的芯片的存储器编写描述，再生成固件映像；如果仍然太大，用 `rungc build --report` 查看各部分占用的空间。没有擦除任何内容。

# the image could not be written and verified
# Writing was begun and did not end with flash that holds the image: the line or the supply was interrupted, the boot loader rejected a command several times, or what was read back differs. Run the same command again: it keeps what is already there and writes the rest. The first page is erased first and written last, so a part that was left in between has no program and does not switch outputs. If it fails at the same address each time, the flash is worn out or smaller than the part says; if at different ones, choose a lower `--baud` and a shorter cable.
E0854 = 固件映像未能写入并校验
    .text = 写入已经开始，但结束时闪存中没有完整的固件映像：线路或电源中断，引导程序多次拒绝命令，或读回的内容不同。再次执行同一命令：已写入的部分保留，只写其余部分。首页最先擦除、最后写入，因此中途停止的芯片中没有程序，也不会驱动输出。如果每次都在同一地址失败，说明闪存已磨损，或小于芯片所报告的大小；如果地址每次不同，改用更低的 `--baud` 和更短的电缆。

# no volume of a boot loader is there
# The boot ROM of an RP2040 shows a volume called RPI-RP2 over USB while BOOTSEL is held when the board gets its supply, or when flash is empty. It has a file INFO_UF2.TXT that says whose it is, and `rungc flash --volume auto` looks for that file on all mounted volumes. On a system without a desktop nothing mounts it: `udisksctl mount -b /dev/sda1`, or mount it as root, and name the folder with `--volume`. A cable that only charges shows nothing. Nothing has been erased.
E0855 = 没有引导程序的存储卷
    .text = 电路板上电时按住 BOOTSEL，或闪存为空时，RP2040 的引导 ROM 通过 USB 显示一个名为 RPI-RP2 的存储卷。其中的文件 INFO_UF2.TXT 说明它的来源，`rungc flash --volume auto` 在所有已挂载的卷中查找此文件。没有桌面的系统不会自动挂载：用 `udisksctl mount -b /dev/sda1`，或以 root 身份挂载，再用 `--volume` 指定文件夹。只能充电的电缆不会显示任何卷。没有擦除任何内容。

# a terminal of the program is at a pin that is not certain
# The description of the board marks this pin as uncertain: it comes from one published source, or its polarity or range is not published, and boards of the same name are sold with other pins. Write the pins-only image first (`rungc boards BOARD --pins-only -o pins.elf`), which reads inputs and switches one output at a time, and compare the terminals. `rungc boards BOARD --toml` writes the description, in which you correct the pin or remove `uncertain`.
W0850 = 程序的端子接在未确认的引脚上
    .text = 电路板的描述把此引脚标为未确认：它只有一个公开的来源，或极性、量程没有公开，而且同名的电路板在市场上有不同的引脚。先写入只测试引脚的固件映像（`rungc boards BOARD --pins-only -o pins.elf`），它读取输入，并且每次只接通一个输出，用来核对端子。`rungc boards BOARD --toml` 写出描述，可在其中更正引脚，或删除 `uncertain`。
