const rows = [...document.querySelectorAll("#devices tr")].map((row) => [row, row.textContent.toLowerCase()]);
const search = document.querySelector("#search");
search.addEventListener("input", () => {
  const wanted = search.value.trim().toLowerCase();
  for (const [row, text] of rows) row.hidden = !text.includes(wanted);
});
