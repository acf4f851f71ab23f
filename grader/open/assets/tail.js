// The end of a long text: the last line stays visible unless the reader has scrolled up.

export class Tail {
  constructor(place) {
    this.place = place;
    this.follows = true;
    place.addEventListener("scroll", () => {
      if (place.clientHeight) this.follows = place.scrollTop + place.clientHeight >= place.scrollHeight - 4;
    });
    // A hidden text cannot be scrolled, so its end is shown as soon as it becomes visible.
    new ResizeObserver(() => this.toEnd()).observe(place);
  }

  write(text) {
    if (this.place.textContent === text) return;
    this.place.textContent = text;
    this.toEnd();
  }

  toEnd() {
    if (this.follows) this.place.scrollTop = this.place.scrollHeight;
  }
}
