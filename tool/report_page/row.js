"use strict";
// Events in order of time that do not overlap: found by halving, summed up by sums made once. So a picture costs its pixels,
// not its events.

class Row {
  /** @param begin, end  times of its events; `index[i]` is the number of event i in its columns. */
  constructor(begin, end, index) {
    this.begin = begin;
    this.end = end;
    this.index = index;
    this.length = begin.length;
    this.busy = new Sum(this, (i) => end[i] - begin[i]);
  }

  /** How many events begin before `time`. */
  begunBefore(time) {
    let low = 0, high = this.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.begin[middle] < time) low = middle + 1; else high = middle;
    }
    return low;
  }

  /** The first event that has not ended at `time`; length when there is none. */
  firstEndingAfter(time) {
    const begun = this.begunBefore(time);
    return begun > 0 && this.end[begun - 1] > time ? begun - 1 : begun;
  }

  /** The event at `time`, or the nearest one within `slack`; -1 when there is none. */
  near(time, slack) {
    const after = this.begunBefore(time);
    let best = -1, distance = slack;
    for (const i of [after - 1, after]) {
      if (i < 0 || i >= this.length) continue;
      const away = Math.max(this.begin[i] - time, time - this.end[i], 0);
      if (away <= distance) [best, distance] = [i, away];
    }
    return best;
  }

  /** A row of those of its events for which `wanted(i)`. */
  filter(wanted) {
    const kept = [];
    for (let i = 0; i < this.length; ++i) if (wanted(i)) kept.push(i);
    return new Row(Float64Array.from(kept, (i) => this.begin[i]), Float64Array.from(kept, (i) => this.end[i]),
                   Uint32Array.from(kept, (i) => this.index[i]));
  }

  /** A row of the parts of its events that lie within events of another row. */
  within(other) {
    const begin = [], end = [], index = [];
    for (let i = 0, j = 0; i < this.length && j < other.length;) {
      const from = Math.max(this.begin[i], other.begin[j]), to = Math.min(this.end[i], other.end[j]);
      if (from < to) {
        begin.push(from);
        end.push(to);
        index.push(this.index[i]);
      }
      if (this.end[i] < other.end[j]) ++i; else ++j;
    }
    return new Row(Float64Array.from(begin), Float64Array.from(end), Uint32Array.from(index));
  }
}

/** What the events of a row amount to up to a time, each spread evenly over its duration. */
class Sum {
  constructor(row, weight) {
    this.row = row;
    this.before = new Float64Array(row.length + 1);
    for (let i = 0; i < row.length; ++i) this.before[i + 1] = this.before[i] + weight(i);
  }

  at(time) { return this.upTo(this.row.begunBefore(time), time); }

  /** As at(), when it is known how many events have begun. */
  upTo(begun, time) {
    if (begun === 0) return 0;
    const i = begun - 1, begin = this.row.begin[i], duration = this.row.end[i] - begin;
    const part = duration > 0 ? Math.min(1, (time - begin) / duration) : 1;
    return this.before[i] + (this.before[begun] - this.before[i]) * part;
  }

  between(from, to) { return this.at(to) - this.at(from); }
}
