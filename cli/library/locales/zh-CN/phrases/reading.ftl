# 16-bit instructions accept H0 to HFFFF, 32-bit ones H0 to HFFFFFFFF
t-16-bit-instructions-accept-h0-to-hffff-32-db35ccaf = 16 位指令接受 H0 到 HFFFF，32 位指令接受 H0 到 HFFFFFFFF

# 16-bit instructions accept K-32768 to K32767, 32-bit ones K-2147483648 to K2147483647
t-16-bit-instructions-accept-k-32768-to-k32767-4cff1825 = 16 位指令接受 K-32768 到 K32767，32 位指令接受 K-2147483648 到 K2147483647

# 16-bit instructions accept K1 to K4, 32-bit ones K1 to K8
t-16-bit-instructions-accept-k1-to-k4-32-93de3a41 = 16 位指令可用 K1～K4，32 位指令可用 K1～K8

# 8 and 9 are not octal digits
t-8-and-9-are-not-octal-digits-42e68c81 = 八进制没有 8 和 9

# `{file}` defines this
t-file-defines-this-c00c3905 = 在 `{ $file }` 中定义

# `{name}` is defined in `{file}`, which has its own PROGRAM and is left out
t-name-is-defined-in-file-which-has-its-09ed209b = `{ $name }` 在 `{ $file }` 中定义，该文件自带 PROGRAM，因此不参与编译

# a floating constant starts with E here
t-a-floating-constant-starts-with-e-here-7f3e85fc = 此处浮点常数以 E 开头

# a group of bits starts with K
t-a-group-of-bits-starts-with-k-8c9d5962 = 位元件组以 K 开头

# a hexadecimal constant starts with H here
t-a-hexadecimal-constant-starts-with-h-here-15c6ae30 = 此处十六进制常数以 H 开头

# a label is to the left of the rail
t-a-label-is-to-the-left-of-the-42d40e8b = 标号应位于左母线的左侧

# a letter where a digit is expected
t-a-letter-where-a-digit-is-expected-85d4e309 = 此处应为数字，却是字母

# a mnemonic starts with a letter
t-a-mnemonic-starts-with-a-letter-9beb6190 = 助记符以字母开头

# a name is one word, which a pointer may follow: `SBR name P1`
t-a-name-is-one-word-which-a-pointer-36c96557 = 名称是一个词，其后可以有指针：`SBR name P1`

# a number without its device
t-a-number-without-its-device-5100eaeb = 只有数字，没有软元件

# a number without its kind
t-a-number-without-its-kind-dc890bbb = 只有数字，没有类型

# a number without its {prefix}
t-a-number-without-its-prefix-18656be1 = 数字前缺少 { $prefix }

# a program has at most 64000 steps
t-a-program-has-at-most-64000-steps-5a1c51b5 = 程序最多有 64000 步

# a step number is a decimal number
t-a-step-number-is-a-decimal-number-e9851ede = 步号是十进制数

# a text of this row begins with a quote and takes in the next rows
t-a-text-of-this-row-begins-with-a-46133e22 = 此行的一个文本以双引号开头，把后面的行也包含了进去

# add `END` as the last instruction
t-add-end-as-the-last-instruction-a1ace326 = 加 `END` 作为最后一条指令

# add the interrupt pointer: `INT_01 I001`
t-add-the-interrupt-pointer-int-01-i001-a867479e = 加上中断指针：`INT_01 I001`

# add the interrupt pointer: `INT name I001`
t-add-the-interrupt-pointer-int-name-i001-8c708dcb = 加上中断指针：`INT name I001`

# add the name of the subroutine: `SBR name`
t-add-the-name-of-the-subroutine-sbr-name-5e3fa9c0 = 加上子程序的名称：`SBR name`

# add them to a task in GX Works2 if they are part of the program
t-add-them-to-a-task-in-gx-works2-fd0b7fad = 如果它们属于程序，在 GX Works2 中把它们加入任务

# an `END` is missing
t-an-end-is-missing-6083b60f = 缺少 `END`

# an FX-family PLC runs one program file: move what you need from the others into it
t-an-fx-family-plc-runs-one-program-file-4a0336a3 = FX 系列 PLC 只运行一个程序文件：把其他程序文件中需要的内容移到其中

# an FX list names devices: `LD X000`, `ANI X001`, `OUT Y000`, `END`
t-an-fx-list-names-devices-ld-x000-ani-19d25dee = FX 指令表写软元件：`LD X000`、`ANI X001`、`OUT Y000`、`END`

# an image begins with 92 bytes of parameters; the program follows them
t-an-image-begins-with-92-bytes-of-parameters-63d1052e = 映像以 92 字节的参数开头，其后是程序

# an image ends before it
t-an-image-ends-before-it-fd81f183 = 映像在它之前结束

# an instruction is a mnemonic and its operands, for example `OUT T0 K30`; comments start with `;` or `//`
t-an-instruction-is-a-mnemonic-and-its-operands-c00243e0 = 指令由助记符和操作数组成，如 `OUT T0 K30`；注释以 `;` 或 `//` 开头

# an operand is for example `{prefix}10`, with an index register `D0Z0`, or a bit of a word `D0.F`
t-an-operand-is-for-example-prefix-10-with-4336f74c = 操作数的写法如 `{ $prefix }10`，带变址寄存器的如 `D0Z0`，字元件的位如 `D0.F`

# `;` and `//` start a comment
t-and-start-a-comment-42aaeaa7 = `;` 和 `//` 是注释的开头

# another window has this name
t-another-window-has-this-name-cbecda6f = 另一个窗口有此名称

# bit 10 is `.A`, bit 15 is `.F`
t-bit-10-is-a-bit-15-is-f-4cd6e195 = 位 10 写作 `.A`，位 15 写作 `.F`

# check the exponent
t-check-the-exponent-2fbd336b = 检查指数

# check the exponent, or write `E0`
t-check-the-exponent-or-write-e0-1a5a40f0 = 检查指数，或写成 `E0`

# check the number for surplus digits
t-check-the-number-for-surplus-digits-780199de = 检查编号是否有多余的数字

# close the text
t-close-the-text-f33cd10f = 结束字符串

# comments start with `;` or `//` and end with their line
t-comments-start-with-or-and-end-with-their-2324a2b1 = 注释以 `;` 或 `//` 开头，到行末为止

# compare with the editor; `rungc learn PROJECT EXPORT` confirms the codes from a list that it exports
t-compare-with-the-editor-rungc-learn-project-export-ca7e4a1b = 与编程软件对照；`rungc learn PROJECT EXPORT` 根据其导出的指令表证实这些编码

# compare with the editor's list of the PLC
t-compare-with-the-editor-s-list-of-the-8c903be9 = 与编程软件中此 PLC 的指令表对照

# constant without a value
t-constant-without-a-value-b92fef53 = 常数没有数值

# convert the program in the editor (Rebuild All) and save the project: rungc then reads its compiled program
t-convert-the-program-in-the-editor-rebuild-all-bd49d5d3 = 在编程软件中转换程序（Rebuild All）并保存工程：rungc 随后读取其编译后的程序

# copy the file again, and compare its size with that of the original
t-copy-the-file-again-and-compare-its-size-fad30a9e = 重新复制文件，并与原文件比较大小

# copy the project again
t-copy-the-project-again-56cdb7e2 = 重新复制工程

# ; decimal {n} is `{number}`
t-decimal-n-is-number-8f8294d8 = ；十进制的 { $n } 写作 `{ $number }`

# delete it, and what is below it if that is not part of the program
t-delete-it-and-what-is-below-it-if-37951384 = 删除它；如果其后的内容不属于程序，也一并删除

# delete the Ctrl-Z and the bytes below it, or copy the whole file again from where it comes
t-delete-the-ctrl-z-and-the-bytes-below-2ce55e63 = 删除 Ctrl-Z 及其后的字节，或从来源处重新复制整个文件

# device without a number
t-device-without-a-number-7f4f26c5 = 软元件没有编号

# devices are {classes}; constants start with K, H or E; text is quoted
t-devices-are-classes-constants-start-with-k-h-8d0d109f = 软元件有 { $classes }；常数以 K、H 或 E 开头；字符串加双引号

# did you mean `{meant}`?
t-did-you-mean-meant-be0f66f4 = 是否应为 `{ $meant }`？

# did you mean `{near}`?
t-did-you-mean-near-5b53f7fd = 是否应为 `{ $near }`？

# expected an instruction, found `{word}`
t-expected-an-instruction-found-word-77a0cddc = 此处应为指令，实际是 `{ $word }`

# export the list from the editor: `rungc learn PROJECT EXPORT` learns the code from it
t-export-the-list-from-the-editor-rungc-learn-550000ac = 从编程软件导出指令表，再用 `rungc learn PROJECT EXPORT` 学习此编码

# export the list of the compiled program, or write the device that the label stands for
t-export-the-list-of-the-compiled-program-or-359ff1dc = 导出编译后程序的指令表，或直接写出标签对应的软元件

# export the project again
t-export-the-project-again-777e9985 = 重新导出工程

# floating constant
t-floating-constant-ef13e259 = 浮点常数

# floating constant `{text}` is too close to 0
t-floating-constant-text-is-too-close-to-0-a0c5136b = 浮点常数 `{ $text }` 过于接近 0

# H is H0 to HFFFFFFFF
t-h-is-h0-to-hffffffff-734847a4 = H 为 H0 到 HFFFFFFFF

# if it is yours, delete the keyword in the editor and save the project again
t-if-it-is-yours-delete-the-keyword-in-522d99e1 = 如果工程是您的，请在编程软件中删除密码（关键字）后重新保存

# if it is yours, delete the keyword in the editor and read the PLC again
t-if-it-is-yours-delete-the-keyword-in-53fbf3a4 = 如果程序是您的，请在编程软件中删除密码（关键字）后重新读取 PLC

# if `{step}` is the step number, put a space after it: `{step} {rest}`
t-if-step-is-the-step-number-put-a-4fa4337b = 如果 `{ $step }` 是步号，在其后加空格：`{ $step } { $rest }`

# if other files are meant, list them in rungc.toml: `[project] program = ["Main.st", "Valves.st"]`
t-if-other-files-are-meant-list-them-in-12891b18 = 如果指的是其他文件，请在 rungc.toml 中列出：`[project] program = ["Main.st", "Valves.st"]`

# in the project
t-in-the-project-b960ecc8 = 工程中

# is one word
t-is-one-word-6d17c18b = 应连写，中间没有空格

# it is a table of device comments, as editors export it; rename it if it is something else
t-it-is-a-table-of-device-comments-as-c5d99f84 = 它是编程软件导出的软元件注释表；如果是其他内容，给文件改名

# its instruction is missing: export the list again
t-its-instruction-is-missing-export-the-list-again-4e39edcc = 缺少它所属的指令：重新导出指令表

# jumps and calls name the number of a label, for example `P0`
t-jumps-and-calls-name-the-number-of-a-25ef272a = 跳转和调用写出标号的编号，如 `P0`

# K is K-2147483648 to K2147483647
t-k-is-k-2147483648-to-k2147483647-f1863eb9 = K 为 K-2147483648 到 K2147483647

# `{letter}` is U+{code}, not a Latin letter
t-letter-is-u-code-not-a-latin-letter-80e40692 = `{ $letter }` 是 U+{ $code }，不是拉丁字母

# move it to a file without PROGRAM, or list both files in rungc.toml
t-move-it-to-a-file-without-program-or-74145eea = 把它移到没有 PROGRAM 的文件中，或在 rungc.toml 中列出两个文件

# name the file `.st`, begin it with `PROGRAM Name` and end it with `END_PROGRAM`
t-name-the-file-st-begin-it-with-program-1205c230 = 把文件命名为 `.st`，以 `PROGRAM Name` 开头，以 `END_PROGRAM` 结尾

# neither a device nor a constant
t-neither-a-device-nor-a-constant-a7f473b1 = 既不是软元件，也不是常数

# neither an instruction nor an operand
t-neither-an-instruction-nor-an-operand-047000e6 = 既不是指令，也不是操作数

# no closing `"` on this line
t-no-closing-on-this-line-4e136a06 = 此行没有结束的 `"`

# no image shows it
t-no-image-shows-it-b6c43516 = 没有映像出现过它

# no known image shows what these bytes mean
t-no-known-image-shows-what-these-bytes-mean-3278dcd9 = 没有已知的映像说明这些字节的含义

# no model has a device with this number
t-no-model-has-a-device-with-this-number-f7c5e133 = 没有机型有此编号的软元件

# no project or published table shows this code
t-no-project-or-published-table-shows-this-code-a7bcd325 = 没有工程或公开的表出现过此编码

# no subroutine has this name
t-no-subroutine-has-this-name-293f953b = 没有此名称的子程序

# no window is called `{name}`
t-no-window-is-called-name-87e7ffee = 没有名为 `{ $name }` 的程序块

# not a decimal constant
t-not-a-decimal-constant-102847c2 = 不是十进制常数

# not a floating constant
t-not-a-floating-constant-8b19718b = 不是浮点常数

# not a hexadecimal constant
t-not-a-hexadecimal-constant-fc040946 = 不是十六进制常数

# not a pointer
t-not-a-pointer-d8b068c4 = 不是指针

# not an address in buffer memory
t-not-an-address-in-buffer-memory-b066c3b1 = 不是缓冲存储区的地址

# not an instruction
t-not-an-instruction-52677421 = 不是指令

# nothing follows it
t-nothing-follows-it-3ccf3cd5 = 其后没有内容

# only looks like one
t-only-looks-like-one-98398282 = 只是看起来像拉丁字母

# only the compiled program says which device this is
t-only-the-compiled-program-says-which-device-this-04928f5e = 只有编译后的程序才知道它对应哪个软元件

# only X, Y, M and S can be grouped
t-only-x-y-m-and-s-can-be-02b7bada = 只有 X、Y、M 和 S 可以组合

# open it in its editor and export the list of the compiled program
t-open-it-in-its-editor-and-export-the-4d60947b = 在其编辑器中打开，并导出编译后程序的指令表

# open it in the editor that wrote it and export the list of the compiled program
t-open-it-in-the-editor-that-wrote-it-fde879f9 = 在生成它的编辑器中打开，并导出编译后程序的指令表

# open the project in GX Works2, compare, and save it again
t-open-the-project-in-gx-works2-compare-and-c1ab3105 = 在 GX Works2 中打开工程，对照后重新保存

# open the project in its editor and export the list as CSV, which rungc also reads
t-open-the-project-in-its-editor-and-export-3f54d28d = 在编程软件中打开工程，把指令表导出为 CSV，rungc 也能读取

# open the project in its editor and save it again
t-open-the-project-in-its-editor-and-save-b5995ff2 = 在编程软件中打开工程并重新保存

# this file is compiled as a part of `{file}`, the first program that needs it
t-this-file-is-compiled-as-a-part-of-64875ee5 = 此文件作为 `{ $file }` 的一部分编译，后者是第一个需要它的程序

# this file is compiled with {files}
t-this-file-is-compiled-with-files-41600289 = 此文件与 { $files } 一起编译

# {prefix} counts in octal, so {prefix}007 is followed by {prefix}010{decimal}
t-prefix-counts-in-octal-so-prefix-007-is-3abdb41d = { $prefix } 按八进制编号，{ $prefix }007 之后是 { $prefix }010{ $decimal }

# put `"` after the last character
t-put-after-the-last-character-34e84344 = 在最后一个字符之后加 `"`

# put an instruction and all its operands on one line
t-put-an-instruction-and-all-its-operands-on-9605b6d4 = 把指令及其全部操作数写在同一行

# put the heading `SBR {name}` above the list of this subroutine, or write the pointer that is called
t-put-the-heading-sbr-name-above-the-list-75a10526 = 在此子程序的指令表上方加标题 `SBR { $name }`，或写出所调用的指针

# read from these bytes
t-read-from-these-bytes-d6db92c7 = 由这些字节读出

# read the PLC again, from 8000h to the `END` of its program
t-read-the-plc-again-from-8000h-to-the-9326149b = 重新读取 PLC，从 8000h 到程序的 `END`

# read the PLC with its editor, and give rungc the project or its list export
t-read-the-plc-with-its-editor-and-give-6c81c19c = 用编程软件读取 PLC，再把工程或导出的指令表交给 rungc

# remove what follows `END`
t-remove-what-follows-end-56a0bbb0 = 删除 `END` 之后的内容

# `rungc convert --to st -o FOLDER` writes its sources as text, `--to labels` its labels
t-rungc-convert-to-st-o-folder-writes-its-1c2f07a3 = `rungc convert --to st -o FOLDER` 把其源程序写成文本，`--to labels` 写出其标签

# separate its cells as in the other rows, or delete the row
t-separate-its-cells-as-in-the-other-rows-1e72c1d9 = 像其他行那样分隔单元格，或删除此行

# shorter than the parameters that precede a program
t-shorter-than-the-parameters-that-precede-a-program-9e4fce32 = 比程序之前的参数还短

# single precision begins at about 1.18E-38
t-single-precision-begins-at-about-1-18e-38-9e5fc5ce = 单精度的最小值约为 1.18E-38

# single precision ends at about 3.4E+38
t-single-precision-ends-at-about-3-4e-38-79e85c5f = 单精度最大约为 3.4E+38

# step number
t-step-number-e7bd2938 = 步号

# step number `{text}` has no instruction
t-step-number-text-has-no-instruction-c004f3fe = 步号 `{ $text }` 之后没有指令

# step numbers are optional: omit it
t-step-numbers-are-optional-omit-it-de6f2803 = 步号可以省略：去掉它

# steps and automatically assigned devices are those of the last compilation
t-steps-and-automatically-assigned-devices-are-those-of-76b686e5 = 步号和自动分配的软元件是上次编译时的

# `{text}` does not group 1 to 8 digits of 4 bits
t-text-does-not-group-1-to-8-digits-163de83c = `{ $text }` 的组数不是 1～8（每组 4 位）

# `{text}` does not name a bit of a word
t-text-does-not-name-a-bit-of-a-f1227abf = `{ $text }` 不是字元件的位

# `{text}` does not start a comment
t-text-does-not-start-a-comment-94486f7c = `{ $text }` 不是注释的开头

# `{text}` groups {prefix} devices, which cannot be grouped
t-text-groups-prefix-devices-which-cannot-be-grouped-b4fe0874 = `{ $text }` 对不能组合的 { $prefix } 使用了位元件组合

# `{text}` is a label, not a device
t-text-is-a-label-not-a-device-8b3f4ebf = `{ $text }` 是标签，不是软元件

# `{text}` is not an octal number: {prefix} devices have no digits 8 and 9
t-text-is-not-an-octal-number-prefix-devices-82cdaf42 = `{ $text }` 不是八进制编号：{ $prefix } 的编号中没有 8 和 9

# `{text}` lacks its number
t-text-lacks-its-number-a5eceda7 = `{ $text }` 缺少编号或数值

# the bit number is one hexadecimal digit, 0 to F
t-the-bit-number-is-one-hexadecimal-digit-0-2e6ad509 = 位号是一位十六进制数，0～F

# the compiled program
t-the-compiled-program-5efd9003 = 编译后的程序

# the Ctrl-Z
t-the-ctrl-z-2d8602ae = Ctrl-Z 在这里

# the digit count is 1 to 8
t-the-digit-count-is-1-to-8-2c28b152 = 组数为 1～8

# the file ends here
t-the-file-ends-here-65f3ee6e = 文件在这里结束

# the image is protected by a keyword, and its program is not read
t-the-image-is-protected-by-a-keyword-and-0cff493a = 映像受密码（关键字）保护，程序未读取

# the ladder is used
t-the-ladder-is-used-cc65bce5 = 使用梯形图

# the longest program of the file
t-the-longest-program-of-the-file-55556e5e = 文件中最长的程序

# the main program comes first, and once
t-the-main-program-comes-first-and-once-00c68660 = 主程序在最前面，并且只有一个

# the number of
t-the-number-of-e8392b02 = 编号

# the only text is in the column of steps
t-the-only-text-is-in-the-column-of-9012c489 = 只有步号一列中有文字

# the program does not end with `END`, where a PLC stops reading
t-the-program-does-not-end-with-end-where-6a0be9a8 = 程序没有以 `END` 结束，而 PLC 读到那里为止

# the program itself is not affected
t-the-program-itself-is-not-affected-3000df0c = 程序本身不受影响

# the program that the tasks run starts here
t-the-program-that-the-tasks-run-starts-here-175034f4 = 任务所运行的程序从这里开始

# the quote is not closed in this row
t-the-quote-is-not-closed-in-this-row-54b6d14a = 此行中的双引号没有结束

# the rest of the program is a comment
t-the-rest-of-the-program-is-a-comment-16d9c722 = 程序的其余部分成了注释

# the step number column may be empty
t-the-step-number-column-may-be-empty-828866ae = 步号一列可以为空

# the text continues after Ctrl-Z (1Ah), the end of a text in DOS
t-the-text-continues-after-ctrl-z-1ah-the-884b02b6 = Ctrl-Z（1Ah）在 DOS 中表示文本结束，但其后还有文字

# the text ends here, but instructions follow among other bytes
t-the-text-ends-here-but-instructions-follow-among-0fba5fb1 = 文本在这里结束，但其后的其他字节中还有指令

# the XML is damaged here
t-the-xml-is-damaged-here-3bfc2eee = XML 在这里损坏

# this is a PLCopen XML project, not an FX instruction list
t-this-is-a-plcopen-xml-project-not-an-d09456af = 这是 PLCopen XML 项目，不是 FX 指令表

# this is an XML file, not an FX instruction list
t-this-is-an-xml-file-not-an-fx-e71e894d = 这是 XML 文件，不是 FX 指令表

# this is IEC 61131-3 instruction list, not an FX instruction list
t-this-is-iec-61131-3-instruction-list-not-f81036b6 = 这是 IEC 61131-3 指令表，不是 FX 指令表

# this is not the program memory of an FX PLC
t-this-is-not-the-program-memory-of-an-f2b8d9a3 = 这不是 FX 系列 PLC 的程序存储器

# this is structured text, not an FX instruction list
t-this-is-structured-text-not-an-fx-instruction-60f54a3f = 这是结构化文本，不是 FX 指令表

# this label has a space before its number
t-this-label-has-a-space-before-its-number-dce98e98 = 此标号在编号之前有空格

# this operand has a space before its number
t-this-operand-has-a-space-before-its-number-230acf53 = 此操作数在编号之前有空格

# this program
t-this-program-0627b665 = 此程序

# this row has neither an instruction nor a statement
t-this-row-has-neither-an-instruction-nor-a-3116f770 = 此行既没有指令也没有声明

# this shows the language
t-this-shows-the-language-57664a86 = 由此可知所用的语言

# this text continues after Ctrl-Z (1Ah)
t-this-text-continues-after-ctrl-z-1ah-a1eb2937 = 此文本在 Ctrl-Z（1Ah）之后还有内容

# this text has no closing quotation mark
t-this-text-has-no-closing-quotation-mark-8012a087 = 此字符串缺少结束的双引号

# `--to il` and `--to csv` write every instruction
t-to-il-and-to-csv-write-every-instruction-ed95f4f3 = `--to il` 和 `--to csv` 可以写出全部指令

# `--to il` and `--to csv` write such programs
t-to-il-and-to-csv-write-such-programs-3a885930 = `--to il` 和 `--to csv` 可以写出这样的程序

# type `{text}` with Latin letters
t-type-text-with-latin-letters-c3eb0837 = 用拉丁字母输入 `{ $text }`

# unexpected text after the number of this {prefix} device
t-unexpected-text-after-the-number-of-this-prefix-de997aa8 = 此 { $prefix } 软元件的编号之后有多余的文字

# {what} `{text}` is too large
t-what-text-is-too-large-d63e9957 = { $what } `{ $text }` 过大

# windows begin with `MAIN`, `SBR name` and `INT name I001`, the main program first
t-windows-begin-with-main-sbr-name-and-int-07edeb99 = 程序块的标题为 `MAIN`、`SBR name` 和 `INT name I001`，主程序在最前

# words have no digit count, for example `D0`; separate operands with a space
t-words-have-no-digit-count-for-example-d0-c710beeb = 字元件没有组数，如 `D0`；操作数之间用空格分隔

# write for example `E1.5` or `E-1.5E+3`
t-write-for-example-e1-5-or-e-1-25d261ce = 写法如 `E1.5` 或 `E-1.5E+3`

# write for example `H1F`: digits 0 to 9 and A to F, no sign
t-write-for-example-h1f-digits-0-to-9-601f3da1 = 写法如 `H1F`：数字 0～9 和 A～F，没有符号

# write for example `K10`, `K-5`, or `K4M0` for a group of bits
t-write-for-example-k10-k-5-or-k4m0-206da957 = 写法如 `K10`、`K-5`，位元件组合如 `K4M0`

# write for example `{prefix}10`
t-write-for-example-prefix-10-3dce0220 = 写法如 `{ $prefix }10`

# write for example `U0\G5`: module 0, address 5
t-write-for-example-u0-g5-module-0-address-e1aad3ed = 写法如 `U0\G5`：模块 0，地址 5

# write `{h}` for a hexadecimal constant
t-write-h-for-a-hexadecimal-constant-ea98fc2f = 十六进制常数写作 `{ $h }`

# write `{joined}`
t-write-joined-9561d015 = 写成 `{ $joined }`

# write `{k}` for a decimal constant
t-write-k-for-a-decimal-constant-dcd62904 = 十进制常数写作 `{ $k }`

# write `{k}` for a decimal constant, `{h}` for a hexadecimal one
t-write-k-for-a-decimal-constant-h-for-57edca2d = 十进制常数写作 `{ $k }`，十六进制常数写作 `{ $h }`

# write `{meant}`
t-write-meant-cf7baf45 = 改为 `{ $meant }`

# write the device with its letter, for example `{meant}`
t-write-the-device-with-its-letter-for-example-cbbcb4b7 = 写出软元件的字母，如 `{ $meant }`

# `{written}` does not begin a window
t-written-does-not-begin-a-window-4d94cafc = `{ $written }` 不是程序块的标题
