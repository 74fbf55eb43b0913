// Sends what is asked for.
const problem = document.getElementById("problem");

export async function send(command) {
  let error = "";
  try {
    const response = await fetch("command", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(command) });
    if (!response.ok) {
      const text = await response.text();
      error = response.status === 422 ? JSON.parse(text).error : text;
    }
  } catch {
    error = "rungc is not responding.";
  }
  problem.textContent = error;
}

for (const button of document.querySelectorAll("[data-do]")) {
  const { do: name, count } = button.dataset;
  button.addEventListener("click", () => send(count ? { do: name, count: Number(count) } : { do: name }));
}

document.getElementById("pace").addEventListener("change", ({ target }) => send({ do: "pace", slower: Number(target.value) }));

const form = document.getElementById("device");
form.addEventListener("submit", (event) => {
  event.preventDefault();
  const device = form.elements.device.value.trim();
  const text = form.elements.value.value.trim();
  const name = event.submitter?.value ?? "set";
  const value = Number(text.replace(",", "."));
  const takes = { watch: false, "break-on-device": text !== "", set: true, force: true }[name];
  if (takes && (text === "" || Number.isNaN(value))) {
    problem.textContent = "Enter a value: 0 or 1, or a number.";
    form.elements.value.focus();
    return;
  }
  send(takes ? { do: name, device, value } : { do: name, device });
});

// Enter sets the device to the value; without a value it watches it.
form.addEventListener("keydown", (event) => {
  if (event.key !== "Enter" || !event.target.matches("input")) return;
  event.preventDefault();
  const name = form.elements.value.value.trim() === "" ? "watch" : "set";
  form.requestSubmit(form.querySelector(`button[value=${name}]`));
});

const breakpoint = document.getElementById("breakpoint");
breakpoint.addEventListener("submit", (event) => {
  event.preventDefault();
  send({ do: "break-on-network", network: Number(breakpoint.elements.network.value) });
});

// A click on a device in the ladder chooses it.
document.getElementById("ladder").addEventListener("click", ({ target }) => {
  const group = target.closest("[data-device]");
  if (group) form.elements.device.value = group.dataset.device;
});
