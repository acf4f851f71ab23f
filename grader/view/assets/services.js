// The service caller: choose a service, edit its request, and read the response.

export class Services {
  constructor({ form, service, type, request, response, status, call }) {
    Object.assign(this, { service, type, request, response, status });
    this.known = new Map();
    this.waits = null;
    service.addEventListener("change", () => this.choose());
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const chosen = this.known.get(service.value);
      if (!chosen) {
        this.status.textContent = service.value ? `${service.value} is not in the graph.` : "";
        return;
      }
      this.waits = { id: crypto.getRandomValues(new Uint32Array(2)).join("-"), name: chosen.name };
      this.status.textContent = `Waiting for ${chosen.name}`;
      call({ ...this.waits, type: chosen.type, request: request.value });
    });
  }

  show(services) {
    const before = this.service.value;
    this.known = new Map(services.map((each) => [each.name, each]));
    const names = services.map(({ name }) => name);
    // The node of the chosen service may have been stopped only for a moment.
    if (before && !this.known.has(before)) names.push(before);
    this.service.replaceChildren(...names.map((name) => new Option(name, name, false, name === before)));
    if (this.service.value !== before) this.choose();
  }

  choose() {
    const chosen = this.known.get(this.service.value);
    this.type.textContent = chosen?.type ?? "";
    this.request.value = chosen?.request ?? "";
  }

  answer({ id, text, ok }) {
    if (id !== this.waits?.id) return;
    this.response.textContent = text;
    this.response.className = ok ? "" : "failed";
    this.status.textContent = ok ? `${this.waits.name} has responded.` : `The call to ${this.waits.name} failed.`;
    this.waits = null;
  }
}
