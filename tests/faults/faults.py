#!/usr/bin/env python3
"""Lets the machine fail under the program, in every way that it can, and looks at what is left; see docs/robustness.md.

usage: faults.py PROGRAM [--library failing_calls.so] [--parts calls,kills,resume,vanish,disk,limits,inputs] [--commands NAME,...]
                 [--calls open,read,write,fsync,rename,mkdir,stat,malloc] [--places N] [--kills N] [--seed N]

--places is how many calls of each kind fail in turn, spread evenly over those that a command makes (0: every one).
Prints a table; status 1 where anything was not as it must be.
"""
import argparse
import ctypes
import errno
import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from workload import Command, Workload, checksums, contents, remove

WITH_BYTES = [errno.EIO, errno.EINTR, 0]  # 0: one byte only
FAULTS = {
    "open": [errno.EACCES, errno.EMFILE],
    "read": WITH_BYTES,
    "write": [errno.ENOSPC, *WITH_BYTES],
    "fsync": [errno.EIO],
    "rename": [errno.EXDEV],
    "mkdir": [errno.ENOSPC],
    "stat": [errno.EIO],
    "malloc": [errno.ENOMEM],
}
CLONE_NEWNS, MS_REC, MS_PRIVATE, MS_RDONLY, MS_REMOUNT = 0x20000, 0x4000, 0x40000, 1, 32
ROUGH_STATUSES = (1, 2)
MOST_SCANS_LOST = 3


class Findings:
    def __init__(self):
        self.tried = Counter()
        self.failed = Counter()
        self.messages = []

    def note(self, part, command, what, wrong):
        self.tried[part, command] += 1
        if wrong:
            self.failed[part, command] += 1
            self.messages.append(f"{command}, {what}: {wrong}")
            print(f"  {self.messages[-1]}", flush=True)

    def table(self):
        print(f"\n{'part':<16}{'command':<14}{'tried':>7}{'wrong':>7}")
        for (part, command), count in sorted(self.tried.items()):
            print(f"{part:<16}{command:<14}{count:>7}{self.failed[part, command]:>7}")
        print(f"{'sum':<30}{sum(self.tried.values()):>7}{sum(self.failed.values()):>7}")


def judge(work, command, outcome, must_name=True, may_leave=False):
    """What is wrong after a failure of the machine: it is said, and nothing is half there. `may_leave`: nor can anything
    be removed without memory or open files, and the next command to the same place does it."""
    if outcome.status < 0 or outcome.status > 128:
        return f"ended by signal {abs(outcome.status)}: {outcome.text[-200:]}"
    there = work.result(command)
    if outcome.status == 0:
        wrong = work.differs(command)
        # A warning that names what is not there is no silence.
        return "" if not wrong or str(work.folder) in outcome.text else f"status 0 and no word of it, but {wrong}"
    if outcome.status not in ROUGH_STATUSES:
        return f"status {outcome.status}"
    if must_name and str(work.folder) not in outcome.text:
        return f"names no file: {outcome.text.strip()[-200:]!r}"
    # What is made of a run that is whole may fail alone, and says so; and memory may end once the result is whole.
    is_whole = may_leave and not work.differs(command)
    is_expected = command.grows or is_whole or "the run is there, but no" in outcome.text
    if there is not None and there.exists() and not is_expected:
        return f"failed, but the result is there ({work.differs(command) or 'whole'}): {outcome.text.strip()[-200:]!r}"
    left = [name for name in work.leftovers(command) if not (may_leave and ".partial-" in name)]
    return f"left {left}" if left else ""


def learn(work):
    """What clean runs give."""
    for command in work.commands:
        seen = []
        for _ in range(2):
            work.clear()
            begin = time.monotonic()
            outcome = work.run(command)
            command.seconds = time.monotonic() - begin
            if outcome.status != 0:
                sys.exit(f"{command.name}: fails without a fault: {outcome.text}")
            seen.append(checksums(work.result(command)) if command.result else {})
        command.names = set(seen[0])
        command.clean = {name: value for name, value in seen[0].items() if seen[1].get(name) == value}  # times differ
    work.clear()


def count_calls(work, command, common):
    """How many calls of the kind a run without a fault makes; of children of benchmark: the longest."""
    report = Path(common["FAULT_REPORT"])
    report.unlink(missing_ok=True)
    work.run(command, common | {"FAULT_NUMBER": "0"})
    work.clear()
    return max(map(int, report.read_text().split()), default=0)


def calls(work, command, findings, options):
    """One call of the C library fails: the n-th of its kind, and with a full disk all that follow."""
    report = work.folder / "report"
    common = {"LD_PRELOAD": str(options.library), "FAULT_REPORT": str(report)}
    for call, errors in ((call, FAULTS[call]) for call in options.calls.split(",")):
        common |= {"FAULT_CALL": call, "FAULT_UNDER": "" if call == "malloc" else str(work.folder)}
        count = count_calls(work, command, common)
        step = max(1, count // options.places) if options.places else 1
        for error in errors:
            for number in range(1, count + 1, step):
                lasts = {"FAULT_LASTS": "1"} if error in (errno.ENOSPC, errno.ENOMEM) else {}
                fault = common | lasts | {"FAULT_NUMBER": str(number), "FAULT_ERROR": str(error)}
                what = f"{call} {number} of {count}, {errno.errorcode.get(error, 'one byte')}"
                outcome = work.run(command, fault)
                harmless = error in (errno.EINTR, 0)  # to be tried again
                wrong = judge(work, command, outcome, must_name=call != "malloc", may_leave=call in ("malloc", "stat"))
                if harmless and outcome.status != 0:
                    wrong = f"status {outcome.status}: {outcome.text.strip()[-200:]}"
                findings.note(call, command.name, what, wrong)
                work.clear()


def kills(work, command, findings, options):
    """Killed at any moment: the result is whole or absent, and the same command makes it whole, clears up included."""
    if not command.result:
        return
    chance = random.Random(options.seed)
    for _ in range(options.kills):
        moment = chance.uniform(0, 1.1 * command.seconds)
        child = subprocess.Popen(work.line(command), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(moment)
        child.kill()
        child.wait()
        time.sleep(0.05 if command.grows else 0)  # children of benchmark end with it
        wrong = "" if command.grows or not work.result(command).exists() else work.differs(command)
        if not wrong and (command.grows or not work.result(command).exists()):
            outcome = work.run(command)
            wrong = outcome.text if outcome.status else work.differs(command)
            left = work.leftovers(command)
            wrong = wrong or (f"left {left}" if left else "")
        findings.note("kill -9", command.name, f"after {1000 * moment:.0f} ms", wrong)
        work.clear()


def partial_folder(work, command):
    """What a killed command left with a checkpoint in it."""
    folders = [work.place / name for name in work.leftovers(command) if ".partial-" in name]
    return next((folder for folder in folders if (folder / "checkpoint").exists()), None)


def spoil(folder, chance):
    """Damages what a run goes on from; it must notice."""
    name = chance.choice(["checkpoint", "checkpoint.scans", "frames.jsonl", "objects.jsonl"])
    file = folder / name
    data = bytearray(file.read_bytes())
    if name.startswith("checkpoint") and chance.random() < 0.5:
        data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    else:
        data = data[: chance.randrange(len(data) // 2 + 1)]
    file.write_bytes(data)
    return name


def resumed(work, command, whole):
    """What is wrong with the run when it has gone on to its end: the files of an unbroken one are expected."""
    outcome = work.run(command)
    if outcome.status:
        return outcome.text
    got = contents(work.result(command))
    wrong = [name for name in sorted(set(got) | set(whole)) if got.get(name) != whole.get(name)]
    left = work.leftovers(command)
    return f"other bytes in {wrong}" if wrong else f"left {left}" if left else ""


def end(child, chance):
    """Kills a run, or asks it to end: once, which keeps the results so far, or twice."""
    how = chance.choice(["kill", "kill", "kill", "term", "term twice"])
    child.send_signal(signal.SIGKILL if how == "kill" else signal.SIGTERM)
    if how == "term twice":
        time.sleep(0.01)
        child.send_signal(signal.SIGTERM)
    child.wait()
    return how


def resume(work, command, findings, options):
    """Ended at random moments, again while it goes on, now and then with a damaged checkpoint, and resumed to its end.
    With the library also by calls that fail from the n-th on."""
    chance = random.Random(options.seed)
    work.clear()
    work.run(command)
    whole = contents(work.result(command))
    work.clear()
    for call in ("open", "write", "fsync", "rename") if options.library else ():
        resume_after_failing(work, command, findings, options, call, whole)
    for number in range(options.kills):
        moments = []
        for _ in range(chance.randint(1, 3)):
            moment = chance.uniform(0.2, 1.0) * command.seconds
            child = subprocess.Popen(work.line(command), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(moment)
            moments.append(f"{end(child, chance)} after {1000 * moment:.0f} ms")
        left = partial_folder(work, command)
        spoilt = f", {spoil(left, chance)} damaged" if left and number % 4 == 3 else ""
        findings.note("resume", command.name, ", ".join(moments) + spoilt, resumed(work, command, whole))
        work.clear()


def resume_after_failing(work, command, findings, options, call, whole):
    """The n-th call and all that follow find no room: the run ends or does without, and goes on when there is room."""
    report = work.folder / "report"
    common = {"LD_PRELOAD": str(options.library), "FAULT_REPORT": str(report), "FAULT_CALL": call, "FAULT_UNDER": str(work.folder)}
    count = count_calls(work, command, common)
    for number in range(1, count + 1, max(1, count // options.places) if options.places else 1):
        outcome = work.run(command, common | {"FAULT_NUMBER": str(number), "FAULT_ERROR": str(errno.ENOSPC), "FAULT_LASTS": "1"})
        wrong = "" if outcome.status in (0, 1) else f"status {outcome.status}"
        findings.note(f"resume, {call}", command.name, f"{call} {number} of {count}", wrong or resumed(work, command, whole))
        work.clear()


def mount(source, target, kind, flags, data=""):
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.mount(source.encode(), str(target).encode(), kind.encode(), flags, data.encode()) != 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))


def may_mount(folder):
    """Whether this process got mounts of its own."""
    try:
        libc = ctypes.CDLL(None, use_errno=True)
        if libc.unshare(CLONE_NEWNS) != 0:
            return False
        mount("none", "/", "", MS_REC | MS_PRIVATE)
        mount("tmpfs", folder, "tmpfs", 0, "size=64k")
        libc.umount2(str(folder).encode(), 0)
        return True
    except OSError:
        return False


def disk(work, command, findings, options):
    """A full disk of several sizes, and one that nothing can be written to."""
    if not command.result:
        return
    libc = ctypes.CDLL(None, use_errno=True)
    sizes = [4, 16, 64, 256]
    for size in [*sizes, None]:
        mount("tmpfs", work.place, "tmpfs", 0, f"size={size or 64}k")
        if size is None:
            mount("none", work.place, "", MS_REMOUNT | MS_RDONLY)
        outcome = work.run(command)
        findings.note("disk", command.name, f"{size} KiB" if size else "read-only", judge(work, command, outcome))
        libc.umount2(str(work.place).encode(), 2)


def limits(work, command, findings, options):
    """What `ulimit` takes away: sizes of files, open files, memory."""
    cases = [("file size", resource.RLIMIT_FSIZE, value) for value in (0, 100, 10_000, 100_000)]
    cases += [("open files", resource.RLIMIT_NOFILE, value) for value in (4, 6, 8, 12)]
    cases += [("memory", resource.RLIMIT_AS, value << 20) for value in (100, 150, 200, 300, 500)]
    for name, kind, value in cases:
        outcome = work.run(command, before=lambda kind=kind, value=value: resource.setrlimit(kind, (value, value)))
        # The loader has its own words and status, before the program begins.
        loader = "error while loading shared libraries" in outcome.text and outcome.status == 127
        wrong = judge(work, command, outcome, must_name=name == "file size", may_leave=name != "file size")
        findings.note("limits", command.name, f"{name} {value}", "" if loader else wrong)
        work.clear()


def inputs(work, command, findings, options):
    """The input disappears or is cut off while it is read."""
    places = [index for index, word in enumerate(command.words) if isinstance(word, Path)]
    if not places:
        return
    chance = random.Random(options.seed)
    source = work.folder / "source"
    for damage in ("gone", "cut"):
        for _ in range(options.places or 10):
            subprocess.run(["cp", "-a", str(command.words[places[0]]), str(source)], check=True)
            words = list(command.words)
            words[places[0]] = source
            moved = Command(command.name, words, command.result, command.grows, command.clean, command.names)
            child = subprocess.Popen(work.line(moved), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
            time.sleep(chance.uniform(0, command.seconds))
            files = [source] if source.is_file() else [file for file in source.rglob("*") if file.is_file()]
            for file in files:
                file.unlink() if damage == "gone" else os.truncate(file, file.stat().st_size // 2)
            text, _ = child.communicate(timeout=120)
            outcome = argparse.Namespace(status=child.returncode, text=text)
            # Read before it was damaged, or found to be damaged; files of the result that name the input differ.
            wrong = "" if outcome.status == 0 or command.grows and outcome.status == 1 else judge(work, moved, outcome)
            if outcome.status == MOST_SCANS_LOST:  # as it says
                wrong = ""
            findings.note("inputs", command.name, damage, wrong)
            remove(source)
            work.clear()


def vanish(work, command, findings, options):
    """A network folder, of the input or of the result, goes away at any moment: no call on anything in it works any more."""
    report = work.folder / "report"
    inputs = next((word for word in command.words if isinstance(word, Path)), None)
    for what, folder in (("input", inputs), ("result", work.place if command.result else None)):
        if folder is None:
            continue
        common = {"LD_PRELOAD": str(options.library), "FAULT_REPORT": str(report), "FAULT_CALL": "file", "FAULT_UNDER": str(folder)}
        count = count_calls(work, command, common)
        for number in range(1, count + 1, max(1, count // options.places) if options.places else 1):
            outcome = work.run(command, common | {"FAULT_NUMBER": str(number), "FAULT_ERROR": str(errno.ESTALE), "FAULT_LASTS": "1"})
            wrong = "" if outcome.status == MOST_SCANS_LOST else judge(work, command, outcome, may_leave=what == "result")
            if not wrong and what == "result":  # back again, and the next command clears up
                outcome = work.run(command)
                wrong = outcome.text if outcome.status else work.differs(command)
                wrong = wrong or (f"left {left}" if (left := work.leftovers(command)) else "")
            findings.note("vanish", command.name, f"{what}, call {number} of {count}", wrong)
            work.clear()


PARTS = {"calls": calls, "kills": kills, "resume": resume, "vanish": vanish, "disk": disk, "limits": limits, "inputs": inputs}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=Path)
    parser.add_argument("--library", type=Path)
    parser.add_argument("--parts", default=",".join(PARTS))
    parser.add_argument("--commands", default="")
    parser.add_argument("--calls", default=",".join(FAULTS))
    parser.add_argument("--places", type=int, default=3)
    parser.add_argument("--kills", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    parts = options.parts.split(",")
    for name, words, known in (("--parts", parts, PARTS), ("--calls", options.calls.split(","), FAULTS)):
        if unknown := [word for word in words if word not in known]:
            parser.error(f"{name}: unknown {unknown[0]!r}, expected some of {','.join(known)}")
    if needy := {"calls", "vanish"} & set(parts) if not options.library else set():
        parser.error(f"part {min(needy)} needs --library")
    signal.signal(signal.SIGXFSZ, signal.SIG_DFL)  # Python ignores it, and children inherit that

    findings = Findings()
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        work = Workload(options.program.resolve(), folder)
        if options.commands:
            chosen = options.commands.split(",")
            work.commands = [command for command in work.commands if command.name in chosen]
        learn(work)
        if "disk" in parts and not may_mount(work.place):
            print("part disk: left out, no right to mount a file system (run as root, or under `unshare -rm`)")
            parts.remove("disk")
        for part in parts:
            for command in work.commands:
                if command.resumes == (part == "resume"):
                    PARTS[part](work, command, findings, options)
    findings.table()
    return 1 if findings.messages else 0


if __name__ == "__main__":
    sys.exit(main())
