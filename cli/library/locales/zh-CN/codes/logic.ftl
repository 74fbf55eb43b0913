# coil or instruction without a contact before it
# Contacts drive coils and most instructions. Only on the sub-bus of a state (after STL) may they be connected directly. To drive something always, use M8000.
E0401 = 线圈或指令前没有触点
    .text = 线圈和大多数指令由触点驱动。只有在状态的副母线上（STL 之后），才可以直接连接。需要始终驱动时，使用 M8000。

# contact with nothing to continue
# AND, OR, INV and related instructions continue a chain of contacts; a chain starts with LD or one of its forms.
E0402 = 触点前没有可以连接的触点
    .text = AND、OR、INV 等指令接在已有的触点之后；一串触点须用 LD 或其各种形式开始。

# contacts that drive nothing
# A chain of contacts must end in a coil or an instruction; here its result is lost.
E0403 = 触点没有驱动任何线圈或指令
    .text = 一串触点必须以线圈或指令结束；此处的运算结果丢失。

# contacts before an instruction that must not have any
# Labels, FOR, NEXT, MCR, STL, RET, SRET, IRET, EI, DI, FEND and END are connected directly to the bus, without a contact before them.
E0404 = 不允许有触点的指令前有触点
    .text = 标号、FOR、NEXT、MCR、STL、RET、SRET、IRET、EI、DI、FEND 和 END 直接接在母线上，前面没有触点。

# ANB or ORB without two blocks to join
# ANB and ORB join the block that starts at the last LD to the one before it. There is no second block.
E0405 = ANB 或 ORB 前没有两个可连接的回路块
    .text = ANB 和 ORB 把从上一个 LD 开始的回路块与它前面的回路块连接起来。此处没有第二个回路块。

# block that is never joined
# A second LD in a rung starts a new block, which ANB or ORB must join to the one before; otherwise its result is lost.
E0406 = 回路块没有连接
    .text = 网络中的第二个 LD 开始一个新的回路块，必须用 ANB 或 ORB 与前面的回路块连接，否则其运算结果丢失。

# more than eight blocks waiting to be joined
# At most eight blocks started with LD may wait for their ANB or ORB. Join each block as soon as it is complete instead of all at the end.
E0407 = 等待连接的回路块超过 8 个
    .text = 用 LD 开始、等待 ANB 或 ORB 的回路块最多 8 个。每个回路块完成后立即连接，不要留到最后一起连接。

# MRD or MPP without MPS
# MRD and MPP use the result that MPS stored at the start of a branch. No result is stored here.
E0408 = MRD 或 MPP 缺少对应的 MPS
    .text = MRD 和 MPP 使用 MPS 在分支开始处存入的运算结果。此处没有存入的结果。

# MPS without MPP
# Every branch that MPS starts must end with MPP, in the same rung.
E0409 = MPS 缺少对应的 MPP
    .text = 用 MPS 开始的每个分支都必须在同一网络中用 MPP 结束。

# more than eleven branches open
# The stack of MPS holds eleven results.
E0410 = 打开的分支超过 11 个
    .text = MPS 的堆栈最多存放 11 个运算结果。

# MRD or MPP in the middle of a block
# A block that starts with LD after MPS must be joined before MRD or MPP returns to the branch.
E0411 = 回路块中间有 MRD 或 MPP
    .text = MPS 之后用 LD 开始的回路块，必须先连接，才能用 MRD 或 MPP 回到分支。
