# a call gives this in its place
t-a-call-gives-this-in-its-place-17404ad0 = 调用时由此处代替它

# a declaration ends in `;`
t-a-declaration-ends-in-b829228a = 声明以 `;` 结束

# a label of CASE is a constant whole number
t-a-label-of-case-is-a-constant-whole-23d1595c = CASE 的分支值是整数常数

# a program declares its labels in `VAR` … `END_VAR`
t-a-program-declares-its-labels-in-var-end-a1a1f649 = 程序在 `VAR` 与 `END_VAR` 之间声明标签

# a register of 16 bits has the bits 0 to F
t-a-register-of-16-bits-has-the-bits-637b84e7 = 16 位寄存器的位为 0～F

# a statement ends in `;`
t-a-statement-ends-in-57b39b9b = 语句以 `;` 结束

# a variable index is computed in Z0 here
t-a-variable-index-is-computed-in-z0-here-b3245f16 = 此处用 Z0 计算变量下标

# a variable index takes 16 bits: begin the array at a lower device
t-a-variable-index-takes-16-bits-begin-the-7f4f9e01 = 变量下标为 16 位：让数组从编号更小的软元件开始

# add its file, or leave out the line
t-add-its-file-or-leave-out-the-line-3cac3675 = 加入它的文件，或去掉这一行

# again here
t-again-here-a6466ab3 = 在此处重复声明

# an index is a whole number
t-an-index-is-a-whole-number-5b44e85f = 下标是整数

# another one
t-another-one-b260b980 = 另一个

# assign it to a label first
t-assign-it-to-a-label-first-4185765d = 先把它赋给标签

# assign it to a label, or the label to it
t-assign-it-to-a-label-or-the-label-9aeb2495 = 把它赋给标签，或把标签赋给它

# assign one of them to a label
t-assign-one-of-them-to-a-label-4692aa03 = 把其中一个赋给标签

# assign parts to labels, or split the statement
t-assign-parts-to-labels-or-split-the-statement-e31550b1 = 把各部分赋给标签，或拆分语句

# assign something to it, `NAME := VALUE;`, or call it, `NAME(…);`
t-assign-something-to-it-name-value-or-call-444c9a61 = 给它赋值，`NAME := VALUE;`，或调用它，`NAME(…);`

# assign the value to a label of your own that several statements share
t-assign-the-value-to-a-label-of-your-4dc1abb0 = 把值赋给自己声明的标签，供多条语句共用

# call `OUT_T(EN, TC0, 50)`, `OUT_C(EN, CC0, 50)` or `RST(EN, TC0)`
t-call-out-t-en-tc0-50-out-c-b6e759ca = 调用 `OUT_T(EN, TC0, 50)`、`OUT_C(EN, CC0, 50)` 或 `RST(EN, TC0)`

# CASE lists this value twice
t-case-lists-this-value-twice-f5803681 = CASE 重复列出此值

# choose another name for the label
t-choose-another-name-for-the-label-09340acc = 给标签换一个名称

# compare it with something, such as `<> 0`
t-compare-it-with-something-such-as-0-1a127a76 = 把它与其他值比较，如 `<> 0`

# convert to DINT, which has a sign: `DWORD_TO_DINT(…)`
t-convert-to-dint-which-has-a-sign-dword-0fd82dfa = 转换为带符号的 DINT：`DWORD_TO_DINT(…)`

# copy it to a label, and back after the call
t-copy-it-to-a-label-and-back-after-9ae2d99a = 先复制到一个标签，调用之后再复制回来

# copy them with `BMOV(EN, From[0], Count, To[0])`
t-copy-them-with-bmov-en-from-0-count-e8f17274 = 用 `BMOV(EN, From[0], Count, To[0])` 复制

# declare it in `VAR` … `END_VAR`, or write a device such as `M0`
t-declare-it-in-var-end-var-or-write-a3c1af10 = 在 `VAR` 与 `END_VAR` 之间声明它，或写出软元件，如 `M0`

# declared here
t-declared-here-4480adaf = 在此处声明

# divide it: `T#5s / T#100ms`
t-divide-it-t-5s-t-100ms-c9e01ccf = 用除法换算：`T#5s / T#100ms`

# EXIT stands in no loop
t-exit-stands-in-no-loop-bb7d9da2 = EXIT 不在循环中

# expected at the latest here
t-expected-at-the-latest-here-76589ac6 = 最迟应在此处出现

# first here
t-first-here-63749d4d = 先在此处声明

# give it in each call, and name what the call gives
t-give-it-in-each-call-and-name-what-4cd8acf6 = 每次调用都给出它，并直接写出调用时所给的内容

# `;` is missing here
t-is-missing-here-3eb51052 = 此处缺少 `;`

# `**` is not compiled yet
t-is-not-compiled-yet-1b9e559b = `**` 尚不能编译

# it has INTERVAL, PRIORITY and SINGLE
t-it-has-interval-priority-and-single-721e0c80 = 它有 INTERVAL、PRIORITY 和 SINGLE

# leave out `AT`
t-leave-out-at-112783e3 = 去掉 `AT`

# leave out INTERVAL, and use TON in the program
t-leave-out-interval-and-use-ton-in-the-0fb71728 = 去掉 INTERVAL，在程序中使用 TON

# name a member or element; only `:=` copies all of them
t-name-a-member-or-element-only-copies-all-05461789 = 写出一个成员或元素；只有 `:=` 能复制全部

# never run
t-never-run-21576b6c = 从不执行

# run the program in each scan, with `IF` around its statements
t-run-the-program-in-each-scan-with-if-6e666898 = 在每次扫描中执行此程序，并把语句放在 `IF` 之内

# state a device with `AT`, or shorten the arrays
t-state-a-device-with-at-or-shorten-the-600ebae1 = 用 `AT` 指定软元件，或缩短数组

# texts are not compiled yet
t-texts-are-not-compiled-yet-63f3cda9 = 字符串尚不能编译

# the constant 0
t-the-constant-0-550fe730 = 常数 0

# the page on structured text lists functions and blocks
t-the-page-on-structured-text-lists-functions-and-5fb36e53 = 函数和功能块见关于结构化文本的一页

# the PLC has no such floating-point number
t-the-plc-has-no-such-floating-point-number-a15be835 = PLC 没有这样的浮点数

# the programs that run
t-the-programs-that-run-f3803117 = 要执行的程序

# the range is that of GX Works2 for this model; join conditions, or split the program
t-the-range-is-that-of-gx-works2-for-c6808701 = 此范围由 GX Works2 为此机型规定；合并条件，或拆分程序

# the step of FOR is a constant other than 0
t-the-step-of-for-is-a-constant-other-1b4519ee = FOR 的步长是 0 以外的常数

# these are not the bounds of an array
t-these-are-not-the-bounds-of-an-array-4f387c4c = 此处不是数组的上下界

# this alone is not a statement
t-this-alone-is-not-a-statement-ac4aef19 = 仅此不构成语句

# this cannot be called
t-this-cannot-be-called-db586f42 = 此处的内容不能调用

# this condition is not compiled yet
t-this-condition-is-not-compiled-yet-b50b3772 = 此条件尚不能编译

# this divides by 0
t-this-divides-by-0-8162ebc0 = 此处除以 0

# this has no members
t-this-has-no-members-37c700c3 = 此处没有成员

# this is never run
t-this-is-never-run-2ba6752c = 此语句从不执行

# this is not a constant
t-this-is-not-a-constant-beb9deb3 = 这不是常数

# this is not a device
t-this-is-not-a-device-3080ce7d = 此处不是软元件

# this is not an array
t-this-is-not-an-array-9a536870 = 此处不是数组

# this is not closed
t-this-is-not-closed-9a8908aa = 此处没有对应的结束

# this is not compiled yet
t-this-is-not-compiled-yet-8274618f = 此处尚不能编译

# this is the second CONFIGURATION
t-this-is-the-second-configuration-795a8692 = 这是第二个 CONFIGURATION

# this leaves before it
t-this-leaves-before-it-452c40df = 此处先行离开

# this text holds no PROGRAM
t-this-text-holds-no-program-bdec62d5 = 此文本中没有 PROGRAM

# types are BOOL, INT, WORD, DINT, DWORD, REAL, TIME, TIMER and COUNTER
t-types-are-bool-int-word-dint-dword-real-d29cd0b3 = 类型有 BOOL、INT、WORD、DINT、DWORD、REAL、TIME、TIMER 和 COUNTER

# use Z1 or one above it
t-use-z1-or-one-above-it-5d03d6ac = 使用 Z1 或编号更大的变址寄存器

# write for example `AT X0`, `AT D10`, `AT D10.3` or `AT K4M0`
t-write-for-example-at-x0-at-d10-at-fc1f2f95 = 例如写 `AT X0`、`AT D10`、`AT D10.3` 或 `AT K4M0`

# write `Instance(Input := value, Output => label)`
t-write-instance-input-value-output-label-f11c2b30 = 写作 `Instance(Input := value, Output => label)`

# write `PROGRAM Main`, the statements, and `END_PROGRAM`
t-write-program-main-the-statements-and-end-program-00c8f8f3 = 写出 `PROGRAM Main`、语句和 `END_PROGRAM`

# write the device, such as `X0`, `M10` or `D10`
t-write-the-device-such-as-x0-m10-or-fac6d558 = 写出软元件，如 `X0`、`M10` 或 `D10`

# write `:= VALUE`
t-write-value-8cec5594 = 写出 `:= VALUE`
