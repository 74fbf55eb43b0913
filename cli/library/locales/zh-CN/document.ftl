# { $plc }, { $steps ->
# [one] { $steps } step
# *[other] { $steps } steps
# } in { $networks ->
# [one] { $networks } network
# *[other] { $networks } networks
# }
doc-about = { $plc }，{ $networks } 个网络，共 { $steps } 步

# Contents
doc-contents = 目录

# Terminals
doc-terminals = 端子

# What drives each output
doc-outputs = 各输出的驱动条件

# Sequence
doc-chart = 顺序流程

# Timers and counters
doc-timers = 定时器和计数器

# Special devices
doc-specials = 特殊软元件

# Instructions
doc-instructions = 指令

# Properties
doc-properties = 性质

# Open questions
doc-open = 待确认事项

# Devices
doc-devices = 软元件

# Ladder
doc-ladder = 梯形图

# Terminal
doc-terminal = 端子

# Device
doc-device = 软元件

# Comment
doc-comment = 注释

# Use
doc-use = 用途

# Networks
doc-in-networks = 网络

# Preset
doc-preset = 设定值

# Time
doc-time = 时间

# Meaning
doc-meaning = 含义

# Instruction
doc-instruction = 指令

# driven if
doc-driven-if = 驱动条件

# executed if
doc-executed-if = 执行条件

# The program has errors, so conditions are not known: see the open questions.
doc-rejected = 程序有错误，因此条件未知：见待确认事项。

# The program drives no output.
doc-no-outputs = 程序不驱动任何输出。

# A check finds nothing, and all used terminals have a comment.
doc-no-open = 检查没有发现问题，所有用到的端子都有注释。

# { $count ->
# [one] A terminal has no comment: { $names }
# *[other] { $count } terminals have no comment: { $names }
# }
doc-nameless = { $count } 个端子没有注释：{ $names }
