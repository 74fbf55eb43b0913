-- Edits a list with `rungc lsp` in Neovim 0.7 or newer:
-- RUNGC=… LIST=… nvim --headless --clean -c 'luafile editor.lua'
local function check(condition, what)
  if not condition then
    io.stderr:write(what .. '\n')
    vim.cmd('cquit')
  end
end

vim.o.hidden = true
vim.cmd('edit ' .. vim.fn.fnameescape(vim.env.LIST))
local id = vim.lsp.start_client({
  name = 'rungc',
  cmd = { vim.env.RUNGC, 'lsp' },
  root_dir = vim.fn.fnamemodify(vim.env.LIST, ':h'),
})
check(id, 'the server does not start')
vim.lsp.buf_attach_client(0, id)

local function found(count)
  local is_there = vim.wait(20000, function() return #vim.diagnostic.get(0) == count end, 20)
  check(is_there, count .. ' findings expected: ' .. vim.inspect(vim.diagnostic.get(0)))
  return vim.diagnostic.get(0)
end

local function ask(method, params)
  local answers, problem = vim.lsp.buf_request_sync(0, 'textDocument/' .. method, params, 20000)
  local answer = answers and answers[id] or {}
  check(answer.result, method .. ': ' .. vim.inspect(problem or answer))
  return answer.result
end

local function lines() return table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, true), '\n') end

local finding = found(1)[1]
check(finding.code == 'E0002' and finding.lnum == 2 and finding.col == 4, vim.inspect(finding))
local client = vim.lsp.get_client_by_id(id)
local encoding = client.offset_encoding or 'utf-16'

-- The fix.
vim.api.nvim_win_set_cursor(0, { 3, 4 })
local params = vim.lsp.util.make_range_params(0, encoding)
params.context = { diagnostics = {} }
for _, action in ipairs(ask('codeAction', params)) do
  if action.kind == 'quickfix' then vim.lsp.util.apply_workspace_edit(action.edit, encoding) end
end
check(lines():find('MOV H1F D10', 1, true), lines())
found(0)

-- Hover and rename on a device behind wide characters.
vim.api.nvim_win_set_cursor(0, { 2, 4 })
local hover = ask('hover', vim.lsp.util.make_position_params(0, encoding))
check(hover.contents.value:find('启动按钮', 1, true), vim.inspect(hover))
params = vim.lsp.util.make_position_params(0, encoding)
params.newName = 'X10'
vim.lsp.util.apply_workspace_edit(ask('rename', params), encoding)
check(lines():find(';! X010 = 启动按钮 😀\nLD X010 ; 按下 😀', 1, true), lines())
check(#ask('documentSymbol', { textDocument = vim.lsp.util.make_text_document_params() }) == 3, 'symbols')

-- What is typed in insert mode arrives.
vim.api.nvim_buf_set_lines(0, 4, 4, true, { 'OUT Y8' })
check(found(1)[1].code == 'E0003', vim.inspect(vim.diagnostic.get(0)))
client.stop()
vim.wait(5000, function() return client.is_stopped() end, 20)
check(client.is_stopped(), 'the server does not stop')
print('ok')
vim.cmd('qall!')
