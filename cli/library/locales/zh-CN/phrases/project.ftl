# {first}, and so are {count} more operands
t-first-and-so-are-count-more-operands-bfd9207e = { $first }，另有 { $count } 个操作数也是如此

# the compiled program starts here
t-the-compiled-program-starts-here-70971256 = 编译后的程序从这里开始

# the modules beside it have the numbers 0 to 7
t-the-modules-beside-it-have-the-numbers-0-4bdbc823 = 旁边的模块编号为 0～7

# unknown
t-unknown-9b759fb9 = 未知
