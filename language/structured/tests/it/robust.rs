//! Texts by chance, and texts that nest deep: they are reported, and take neither long nor much of the stack.
