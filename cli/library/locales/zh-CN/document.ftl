doc-about = { $plc }，{ $networks } 个网络，共 { $steps } 步

doc-contents = 目录

doc-terminals = 端子

doc-outputs = 各输出的驱动条件

doc-chart = 顺序流程

doc-timers = 定时器和计数器

doc-specials = 特殊软元件

doc-instructions = 指令

doc-properties = 性质

doc-open = 待确认事项

doc-devices = 软元件

doc-ladder = 梯形图

doc-terminal = 端子

doc-device = 软元件

doc-comment = 注释

doc-use = 用途

doc-in-networks = 网络

doc-preset = 设定值

doc-time = 时间

doc-meaning = 含义

doc-instruction = 指令

doc-driven-if = 驱动条件

doc-executed-if = 执行条件

doc-rejected = 程序有错误，因此条件未知：见待确认事项。

doc-no-outputs = 程序不驱动任何输出。

doc-no-open = 检查没有发现问题，所有用到的端子都有注释。

doc-nameless = { $count } 个端子没有注释：{ $names }
