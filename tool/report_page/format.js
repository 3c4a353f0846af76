"use strict";
// Numbers as people read them. Times are nanoseconds, sizes bytes.

/** Three significant digits, without an exponent. */
function threeDigits(value) {
  const magnitude = Math.abs(value);
  return value.toFixed(magnitude >= 100 || value === Math.round(value) ? 0 : magnitude >= 10 ? 1 : 2);
}

function scaled(value, steps) {
  let [factor, unit] = steps[0];
  for (const [f, u] of steps) {
    if (Math.abs(value) >= f) [factor, unit] = [f, u];
  }
  return `${threeDigits(value / factor)} ${unit}`;
}

const format = {
  time: (ns) => scaled(ns, [[1, "ns"], [1e3, "µs"], [1e6, "ms"], [1e9, "s"]]),
  /** A time as fine as `step`, so that neighbours on an axis differ, in the unit that suits `largest`. */
  timeInSteps(ns, step, largest) {
    const [factor, unit] = [[1e9, "s"], [1e6, "ms"], [1e3, "µs"], [1, "ns"]].find(([f]) => largest >= f) ?? [1, "ns"];
    const decimals = Math.max(0, Math.ceil(Math.log10(factor / step) - 1e-9));
    return ns === 0 ? "0" : `${(ns / factor).toFixed(decimals)} ${unit}`;
  },
  /** To the nanosecond, for one event. */
  exactTime: (ns) => `${(ns / 1e3).toFixed(3).replace(/\B(?=(\d{3})+(?=\.))/g, " ")} µs`,
  /** Bytes that move, in the units of `rate`: 1 kB is 1000 bytes. */
  bytes: (n) => scaled(n, [[1, "bytes"], [1e3, "kB"], [1e6, "MB"], [1e9, "GB"]]),
  /** Bytes of local store, of which there are 256 KiB: 1 KiB is 1024 bytes. */
  store: (n) => scaled(n, [[1, "bytes"], [1024, "KiB"]]),
  rate: (bytesPerSecond) => scaled(bytesPerSecond, [[1, "B/s"], [1e3, "kB/s"], [1e6, "MB/s"], [1e9, "GB/s"]]),
  count: (n) => String(n).replace(/\B(?=(\d{3})+(?!\d))/g, " "),
  percent: (share) => share > 0 && share < 0.001 ? "< 0.1 %" : `${(100 * share).toFixed(share !== 0 && share < 0.0995 ? 1 : 0)} %`,
  address: (value) => `0x${value.toString(16).toUpperCase().padStart(5, "0")}`,
};

/** Words with their number: "1 job", "2 jobs". */
function plural(count, word) {
  return `${format.count(count)} ${word}${count === 1 ? "" : "s"}`;
}
