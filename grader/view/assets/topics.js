// The table of topics: their publishers, subscribers and rates.

// The maximum rate that is measured (Hz).
const MOST_HZ = 500;

function cell(name, ...parts) {
  const made = document.createElement(name);
  made.append(...parts);
  return made;
}

// On a narrow page, the label is shown before the content, since the columns do not fit.
function labelled(label, ...parts) {
  const made = cell("td", ...parts);
  made.dataset.label = label;
  return made;
}

function names(label, all) {
  return labelled(label, ...(all.length ? all.flatMap((name) => [cell("span", name), " "]) : [cell("span", "nobody")]));
}

export class Topics {
  constructor(table) {
    this.body = table.tBodies[0];
    this.told = null;
  }

  show(topics) {
    const text = JSON.stringify(topics);
    if (text === this.told) return;
    this.told = text;
    this.body.replaceChildren(...topics.map(({ name, types, publishers, subscribers, hertz }) => {
      const title = cell("th", cell("span", name), " ", cell("small", types.join(", ")));
      title.scope = "row";
      const rate = labelled("Rate", hertz === null ? "–" : hertz < MOST_HZ ? `${hertz} Hz` : `over ${MOST_HZ} Hz`);
      rate.className = "rate";
      const row = cell("tr", title, rate, names("From", publishers), names("To", subscribers));
      row.dataset.topic = name;
      return row;
    }));
  }
}
