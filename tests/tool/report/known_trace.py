"""Traces whose content the tests know, in the format of `--trace`."""

import json

STORE_BYTES = 256 * 1024


def microseconds(nanoseconds):
    return nanoseconds / 1000


class TraceBuilder:
    """Builds a trace event by event; times and durations in nanoseconds."""

    def __init__(self, spes):
        self.spes = spes
        self.events = []
        self.images = []
        self.dropped = [{"jobs": 0, "waits": 0, "commands": 0, "findings": 0} for _ in range(spes)]
        for spe in range(spes):
            self.events.append({"ph": "M", "pid": spe + 1, "tid": (spe + 1) * 1000 + 1, "name": "process_name",
                                "args": {"name": f"SPE {spe}"}})

    def _slice(self, spe, row, category, name, begin, duration, args):
        self.events.append({"ph": "X", "pid": spe + 1, "tid": (spe + 1) * 1000 + row, "ts": microseconds(begin),
                            "dur": microseconds(duration), "cat": category, "name": name, "args": args})

    def job(self, spe, number, name, begin, duration, failed=False):
        self._slice(spe, 1, "job", name, begin, duration, {"job": number, "failed": failed})

    def wait(self, spe, channel, name, begin, duration):
        self._slice(spe, 2, "wait", name, begin, duration, {"channel": channel})

    def command(self, spe, row, name, begin, duration, size, tag=0, lsa="0x01000", ea="0x5EA010000000", completed=True):
        self._slice(spe, 3 + row, "dma", name, begin, duration,
                    {"tag": tag, "lsa": lsa, "ea": ea, "size": size, "bytes": size, "completed": completed})

    def finding(self, spe, when, rule, kernel, place, message, count=1):
        self.events.append({"ph": "i", "s": "p", "pid": spe + 1, "tid": (spe + 1) * 1000 + 1, "ts": microseconds(when),
                            "cat": "finding", "name": rule, "args": {"kernel": kernel, "place": place, "message": message, "count": count}})

    def image(self, name, text, bss, stack, stack_used, objects=(), checked=False):
        bss_begin = (0x80 + text + 127) // 128 * 128
        end = bss_begin + bss
        sections = [("environment", 0, 128), ("text", 0x80, text), ("bss", bss_begin, bss), ("free", end, STORE_BYTES - stack - end),
                    ("stack", STORE_BYTES - stack, stack)]
        self.images.append({"name": name, "checked": checked, "budget": 98304, "stack_used": stack_used,
                            "sections": [{"kind": k, "begin": b, "bytes": n} for k, b, n in sections if n > 0],
                            "objects": [{"name": k, "begin": bss_begin + b, "bytes": n} for k, b, n in objects]})

    def document(self):
        return {"traceEvents": self.events,
                "softcell": {"format": 1, "version": "0.1.0", "time": "microseconds", "spes": self.spes,
                             "dropped": self.dropped, "images": self.images}}

    def write(self, path):
        with open(path, "w", encoding="utf-8") as file:
            json.dump(self.document(), file)


HOSTILE = "</script><script>window.escaped=1</script><!--"


def known_trace():
    """Six SPEs, two kernels, 10 ms; SPE n runs 5 + n jobs of 1000 us, of them 200 us waiting. A failure and three findings."""
    trace = TraceBuilder(6)
    number = 0
    for spe in range(6):
        for i in range(5 + spe):
            begin = i * 1_000_000 + spe * 10_000
            name = "skin" if i % 2 == 0 else "sum_bars"
            failed = spe == 5 and i == 9
            trace.job(spe, number, name, begin, 900_000, failed)
            trace.wait(spe, 24, "MFC_RdTagStat", begin + 100_000, 150_000)
            trace.wait(spe, 23, "MFC_WrTagUpdate", begin + 300_000, 50_000)
            trace.command(spe, 0, "get", begin + 50_000, 200_000, 16384, tag=1)
            trace.command(spe, 1, "getl", begin + 60_000, 180_000, 8192, tag=2)
            trace.command(spe, 0, "put", begin + 500_000, 100_000, 4096, tag=3, completed=not failed)
            number += 1
    message = "SPE 2, kernel skin, skin.cpp:41: load-in-flight: a get of tag 3 is in flight"
    trace.finding(2, 1_200_000, "load-in-flight", "skin", "skin.cpp:41", message)
    trace.finding(3, 2_200_000, "load-in-flight", "skin", "skin.cpp:41", message, count=500)
    trace.finding(3, 3_300_000, "tag-unused", "sum_bars", HOSTILE, HOSTILE)
    trace.image("skin", 6100, 40960, 4096, 1360, [("input", 0, 16384), ("output", 16384, 16384), ("weights", 32768, 8192)])
    trace.image("sum_bars", 2800, 65536, 2048, None, [("(anonymous namespace)::buffers", 0, 65536)], checked=True)
    return trace


def resident_trace():
    """Six SPEs, 10 ms: a resident kernel sleeps, but for a job of 1000 us with 250 us of waits. The last sleep ends within the job."""
    trace = TraceBuilder(6)
    for spe in range(6):
        trace.wait(spe, 11, "SPU_RdEventStat", 0, 3_000_000)
        trace.job(spe, spe, "skin", 3_000_000, 1_000_000)
        trace.wait(spe, 24, "MFC_RdTagStat", 3_200_000, 200_000)
        trace.wait(spe, 11, "SPU_RdEventStat", 3_950_000, 6_050_000)
        trace.command(spe, 0, "get", 3_100_000, 200_000, 16384)
    trace.image("skin", 6100, 40960, 4096, 1360)
    return trace


def long_trace(jobs_per_spe):
    """Six SPEs with so many jobs, each with a wait and two commands: what must still scroll smoothly."""
    trace = TraceBuilder(6)
    for spe in range(6):
        time = spe * 137
        for i in range(jobs_per_spe):
            duration = 2_000 + (i * 7919 + spe * 104729) % 6_000
            trace.job(spe, i * 6 + spe, f"kernel_{i % 3}", time, duration)
            trace.wait(spe, 24, "MFC_RdTagStat", time + 300, duration // 3)
            trace.command(spe, 0, "get", time + 200, duration // 3, 4096)
            trace.command(spe, i % 2, "put", time + 100 + duration // 2, duration // 4, 2048)
            time += duration + 500 + (i % 50 == 0) * 40_000
    trace.image("kernel_0", 4000, 8192, 2048, 512)
    return trace
