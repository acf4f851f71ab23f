// Lists whose elements are replaced only if their content has changed.

// `wanted` is a list of { key, text, make }. If `text` is unchanged, the element is kept.
export function update(place, wanted) {
  const before = new Map([...place.children].map((each) => [each.dataset.key, each]));
  let at = place.firstElementChild;
  for (const { key, text, make } of wanted) {
    let element = before.get(key);
    before.delete(key);
    if (!element || element.told !== text) {
      const made = make();
      made.dataset.key = key;
      made.told = text;
      if (element) {
        if (element === at) at = made;
        element.replaceWith(made);
      }
      element = made;
    }
    if (element === at) at = at.nextElementSibling;
    else place.insertBefore(element, at);
  }
  for (const each of before.values()) each.remove();
}
