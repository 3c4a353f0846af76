"use strict";
// The range of time that is visible, shared by everything that shows time.

class View {
  static least = 20;  // nanoseconds

  constructor(begin, end) {
    this.whole = {begin, end};
    this.listeners = [];
    this.begin = begin;
    this.end = end;
  }

  get span() { return this.end - this.begin; }

  onChange(listener) { this.listeners.push(listener); }

  /** Shows this range, moved and cut so that it lies within the trace. */
  set(begin, end) {
    const {whole} = this;
    const most = whole.end - whole.begin;
    const span = Math.min(Math.max(end - begin, Math.min(View.least, most)), most);
    begin = Math.min(Math.max((begin + end - span) / 2, whole.begin), whole.end - span);
    if (begin === this.begin && begin + span === this.end) return;
    this.begin = begin;
    this.end = begin + span;
    for (const listener of this.listeners) listener();
  }

  /** @param factor  of the span: below 1 zooms in. `at` stays where it is. */
  zoom(factor, at = (this.begin + this.end) / 2) {
    const span = Math.min(Math.max(this.span * factor, View.least), this.whole.end - this.whole.begin);
    const begin = at - (at - this.begin) * (span / this.span);
    this.set(begin, begin + span);
  }

  pan(time) {
    const {whole, span} = this;
    const begin = Math.min(Math.max(this.begin + time, whole.begin), whole.end - span);
    this.set(begin, begin + span);
  }

  fit() { this.set(this.whole.begin, this.whole.end); }

  /** Shows an event in its surroundings. */
  show(begin, end) {
    const margin = Math.max((end - begin) * 0.5, 500);
    this.set(begin - margin, end + margin);
  }

  /** Moves the range just so far that [begin, end] is visible. */
  reveal(begin, end) {
    if (end - begin > this.span) this.show(begin, end);
    else if (begin < this.begin) this.pan(begin - this.begin - this.span * 0.1);
    else if (end > this.end) this.pan(end - this.end + this.span * 0.1);
  }
}
