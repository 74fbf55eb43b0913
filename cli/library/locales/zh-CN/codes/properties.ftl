# the program can violate a property
# `rungc verify` or `rungc explore` has found a run of the program, from power-on with the inputs that it lists, after which the property does not hold. The run has been replayed on the interpreter and happened there. `--write-test` writes it as a test file. Inputs that the machine cannot give, such as both end positions at once, are excluded with `--assume`.
E0800 = 程序可能使性质不成立
    .text = `rungc verify` 或 `rungc explore` 找到了程序的一个运行过程：从上电开始，按所列的输入运行之后，性质不成立。此过程已在解释器上重放，并在那里发生。`--write-test` 把它写成测试文件。机械不可能给出的输入，如两个终端位置同时为 ON，用 `--assume` 排除。

# whether the program has a property is not known
# `rungc verify` has neither found a run that violates the property nor a proof that there is none: the effort was not enough (`--effort` allows more), the time was up (`--timeout`), or something that the property depends on is not modelled, so that a run of the model is not one of the program. The report names what is not modelled.
W0801 = 不知道程序是否具有此性质
    .text = `rungc verify` 既没有找到使性质不成立的运行过程，也没有证明不存在这样的过程：计算量不够（`--effort` 可以增加），时间已到（`--timeout`），或性质所依赖的某些内容没有建模，因此模型的运行过程不等于程序的运行过程。报告列出没有建模的内容。

# a property is about a device that nothing drives
# The property names a device that no instruction writes, that is not an input, and that nothing outside the program writes as far as rungc knows: an output without a coil, or a relay or register that the program does not use. Such an output is always off, so that a property of it is proved of any program; any other such device may have any value, so that a property of it is easily violated. Is the number right? What a panel or another PLC writes is named in rungc.toml, `[hmi] writes = "M500"`, or with `--free`. Special devices, which the PLC itself drives, are not reported.
W0802 = 性质涉及没有驱动的软元件
    .text = 性质中的软元件没有任何指令写入，不是输入，而且据 rungc 所知，程序之外也没有写入者：没有线圈的输出，或程序没有使用的继电器或寄存器。这样的输出始终为 OFF，因此关于它的性质对任何程序都能得到证明；其他这样的软元件可以是任意值，因此关于它的性质很容易不成立。编号是否正确？由触摸屏或其他 PLC 写入的软元件，在 rungc.toml 中写出，`[hmi] writes = "M500"`，或用 `--free` 指定。由 PLC 自身驱动的特殊软元件不报告。

# an output of the program can differ from that of the older one
# `rungc verify --same-as` has found a run in which the output differs, with the same inputs at the same times in both programs. The run has been replayed on both and happened there.
E0821 = 程序的输出可能与旧程序不同
    .text = `rungc verify --same-as` 找到了一个运行过程：两个程序在相同时刻有相同的输入，而输出不同。此过程已在两个程序上重放，并在那里发生。

# whether an output is the same in both programs is not known
# `rungc verify --same-as` has neither found a run in which the output differs nor a proof that there is none: the effort was not enough (`--effort` allows more), the time was up (`--timeout`), or something that is not modelled is used differently in both.
W0821 = 不知道输出在两个程序中是否相同
    .text = `rungc verify --same-as` 既没有找到输出不同的运行过程，也没有证明不存在这样的过程：计算量不够（`--effort` 可以增加），时间已到（`--timeout`），或没有建模的某些内容在两个程序中的用法不同。

# a coil that can never be on
# No run of the program switches this relay or output on, whatever its inputs are: the contacts before it contradict each other, or depend on something that never happens. `rungc check --deep` has proved it, if only the program writes the devices that it writes: name what a panel writes in rungc.toml, `[hmi] writes = "D70-D79"`. Networks that name M8000 or M8001 are left out, since they are meant so, and so are those that depend on a relay that such a network keeps off or on. What follows from a finding is shown with it. RST and ZRST alone make no coil.
W0901 = 线圈永远不会为 ON
    .text = 无论输入如何，程序的任何运行都不会接通此继电器或输出：它前面的触点相互矛盾，或取决于从不发生的情况。`rungc check --deep` 已证明这一点，前提是程序所写的软元件只由程序写入：触摸屏写入的软元件在 rungc.toml 中写出，`[hmi] writes = "D70-D79"`。含有 M8000 或 M8001 的网络不检查，因为这是有意的；取决于由这种网络保持断开或接通的继电器的网络也不检查。由某个结果推出的情况与它一起显示。只有 RST 和 ZRST 的不算线圈。

# a rung that can never do anything
# The scan comes to this rung, but its contacts never conduct, so nothing in it is ever executed; coils beside it may be on, if they have other contacts. SET, RST and CALL count as any other instruction. `rungc check --deep` has proved it, if only the program writes the devices that it writes: name what a panel writes in rungc.toml, `[hmi] writes = "D70-D79"`.
W0902 = 网络永远不起作用
    .text = 扫描会执行到此网络，但其触点从不导通，因此其中的内容从不执行；旁边的线圈如果有其他触点，仍可能为 ON。SET、RST 和 CALL 与其他指令一样看待。`rungc check --deep` 已证明这一点，前提是程序所写的软元件只由程序写入：触摸屏写入的软元件在 rungc.toml 中写出，`[hmi] writes = "D70-D79"`。

# a step that can never be reached
# No run of the program switches this step on: the transition to it never takes place. A step that nothing in the program sets counts as off, unless rungc.toml names it or a server whose clients could set it. `rungc check --deep` has proved it, if only the program writes the devices that it writes: name what a panel writes in rungc.toml, `[hmi] writes = "D70-D79"`.
W0903 = 状态永远执行不到
    .text = 程序的任何运行都不会接通此状态：到它的转移从不发生。程序中没有置位的状态视为 OFF，除非 rungc.toml 写出了它，或写出了其客户端可以置位它的服务器。`rungc check --deep` 已证明这一点，前提是程序所写的软元件只由程序写入：触摸屏写入的软元件在 rungc.toml 中写出，`[hmi] writes = "D70-D79"`。

# a step that can never be left
# Once this step is on, nothing switches it off: no transition leads out of it that can take place. `rungc check --deep` has proved it, if only the program writes the devices that it writes: name what a panel writes in rungc.toml, `[hmi] writes = "D70-D79"`.
W0904 = 状态永远不能离开
    .text = 此状态一旦为 ON，就没有任何东西使它断开：没有能够发生的转移离开它。`rungc check --deep` 已证明这一点，前提是程序所写的软元件只由程序写入：触摸屏写入的软元件在 rungc.toml 中写出，`[hmi] writes = "D70-D79"`。

# a comparison that always has the same result
# In every run of the program, this comparison has the same result whenever the scan comes to it. If it keeps a whole rung open, it is shown with that rung (W0901 to W0903). `rungc check --deep` has proved it, if only the program writes the devices that it writes: name what a panel writes in rungc.toml, `[hmi] writes = "D70-D79"`.
W0905 = 比较的结果总是相同
    .text = 在程序的任何运行中，每次扫描到此比较，其结果都相同。如果它使整个网络断开，则与该网络一起显示（W0901～W0903）。`rungc check --deep` 已证明这一点，前提是程序所写的软元件只由程序写入：触摸屏写入的软元件在 rungc.toml 中写出，`[hmi] writes = "D70-D79"`。

# a timer that can never expire
# The timer's coil can be on, but never long enough, or never in two scans in a row. `rungc check --deep` has proved it, if only the program writes the devices that it writes: name what a panel writes in rungc.toml, `[hmi] writes = "D70-D79"`.
W0906 = 定时器永远不会到时
    .text = 定时器的线圈可能为 ON，但从来不够长，或从不连续两次扫描为 ON。`rungc check --deep` 已证明这一点，前提是程序所写的软元件只由程序写入：触摸屏写入的软元件在 rungc.toml 中写出，`[hmi] writes = "D70-D79"`。

# an output that can change in every scan
# In the run shown, the output is switched on and off in turn, scan by scan, while no input changes. Contactors and relays do not last long that way. `rungc check --deep` has seen it on the interpreter.
W0907 = 输出可能每次扫描都变化
    .text = 在所示的运行过程中，没有任何输入变化，而输出逐次扫描地交替接通和断开。接触器和继电器不能这样长期使用。`rungc check --deep` 在解释器上看到了这一情况。
