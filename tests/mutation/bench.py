"""Builds and judges one mutant: compiles what depends on the source from a mutated copy, links each program of tests with
those objects first, and runs it. The checkout and its build folder stay as they are."""

import fcntl
import json
import os
import re
import resource
import shlex
import shutil
import signal
import subprocess
from pathlib import Path

MEMORY = 4 << 30  # [bytes] a mutant may ask for anything
WAITING = 6  # times its limit of processor time, and a little: what a mutant may wait for its turn or for ever


class Program:
    """A program of tests with the filter of its cases."""

    def __init__(self, word: str, own: bool):
        self.name, _, self.filter = word.partition(":")
        self.own = own  # only the program's own sources are compiled with a mutated header


class Bench:
    def __init__(self, root: Path, build: Path, part: int):
        self.root, self.build = root, build
        self.work = build / "mutants" / str(part)  # benches beside each other have folders of their own
        self.copies = self.work / "src"
        self.copies.mkdir(parents=True, exist_ok=True)
        self.held = (self.work / "lock").open("w")
        try:
            fcntl.flock(self.held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise SystemExit(f"part {part} is being judged already: two would overwrite each other's mutants; take another --part")
        listed = subprocess.run(["ninja", "-t", "compdb"], cwd=build, capture_output=True, text=True, check=True).stdout
        self.compile = {e["output"]: e for e in json.loads(listed) if e["output"].endswith(".o")}
        self.links, self.dependants, self.originals, self.members = {}, {}, {}, {}

    def link_of(self, program: str) -> str:
        """Returns the command that links a program, without what the build does after it."""
        if program not in self.links:
            every = subprocess.run(["ninja", "-t", "commands", program], cwd=self.build, capture_output=True, text=True, check=True).stdout
            last = [line for line in every.splitlines() if f"-o bin/{program} " in line][-1]
            self.links[program] = last.split("&& ")[1].strip()
        return self.links[program]

    def objects_of(self, source: str, program: Program) -> list[str]:
        """Lists the objects in a program that a source goes into."""
        if not source.endswith(".h"):
            return [o for o, e in self.compile.items() if Path(e["file"]) == self.root / source and self.is_in(o, program)]
        key = (source, program.name, program.own)
        if key not in self.dependants:
            listed = subprocess.run(["ninja", "-t", "deps"], cwd=self.build, capture_output=True, text=True, check=True).stdout
            found = []
            for block in listed.split("\n\n"):
                lines = block.strip().splitlines()
                if lines and any(line.strip().endswith("/" + source) for line in lines[1:]):
                    found.append(lines[0].split(": #deps")[0])
            self.dependants[key] = [o for o in found if o in self.compile and self.is_in(o, program)]
        return self.dependants[key]

    def is_in(self, obj: str, program: Program) -> bool:
        link = shlex.split(self.link_of(program.name))
        if obj in link:
            return True
        return not program.own and any(obj in self.members_of(word) for word in link if word.endswith(".a") and word[0] != "/")

    def members_of(self, library: str) -> set[str]:
        """Returns the objects of a library, which may come from several targets."""
        if library not in self.members:
            query = subprocess.run(["ninja", "-t", "query", library], cwd=self.build, capture_output=True, text=True, check=True).stdout
            self.members[library] = {line.strip() for line in query.splitlines() if line.endswith(".o")}
        return self.members[library]

    def compiled(self, source: str, text: str, obj: str) -> bytes | None:
        """Returns the object of this text of a source; None if it does not compile."""
        copy = self.copies / source
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(text)
        entry, out = self.compile[obj], self.work / "mutant.o"
        command = entry["command"].replace(f"-c {self.root / source}", f"-c {copy}")
        command = re.sub(r"-o \S+ -c", f"-o {out} -w -iquote {self.copies} -c", command)
        command = re.sub(r"-MF \S+", f"-MF {self.work / 'mutant.d'}", command)
        command = command.split("ccache ")[-1].replace(" -O3 ", " -O1 ")  # a cache would only grow; quick to compile
        if source.endswith(".h"):  # its old text may be in the precompiled header
            command = re.sub(r"-Winvalid-pch |-include \S*cmake_pch\S* ", "", command)
        done = subprocess.run(command, shell=True, cwd=self.build, capture_output=True, text=True)
        self.errors = done.stderr
        copy.unlink()
        return out.read_bytes() if done.returncode == 0 else None

    def original(self, source: str, obj: str) -> bytes:
        if obj not in self.originals:
            self.originals[obj] = self.compiled(source, (self.root / source).read_text(), obj)
            if self.originals[obj] is None:
                raise SystemExit(f"{source}: does not compile as it is:\n{self.errors}")
        return self.originals[obj]

    def linked(self, program: Program, objects: dict[str, bytes]) -> Path | None:
        """Returns the program with these objects; None if it does not link, such as without an instance of a template."""
        out, command = self.work / program.name, self.link_of(program.name)
        first = []
        for n, (obj, held) in enumerate(objects.items()):
            path = self.work / f"linked_{n}.o"
            path.write_bytes(held)
            if f" {obj} " in command:
                command = command.replace(f" {obj} ", f" {path} ")
            else:
                first.append(str(path))  # its symbols come before those of the same member of a library
        command = command.replace(f" -o bin/{program.name} ", f" {' '.join(first)} -o {out} " + ("-fuse-ld=lld " if shutil.which("ld.lld") else ""))
        return out if subprocess.run(command, shell=True, cwd=self.build, capture_output=True).returncode == 0 else None

    def run(self, path: Path, tests: str, limit: float) -> tuple[str, float]:
        """Returns how the tests ended (passed, the first that failed, timeout or crash) and their processor time [s].

        The limit is of processor time, because a busy machine makes every test late; one that waits for ever ends by the clock.
        """
        arguments = [str(path), "--gtest_fail_fast", "--gtest_brief=1", "--gtest_filter=" + tests]

        def cap():
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_CPU, (int(limit) + 1, int(limit) + 2))

        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        child = subprocess.Popen(arguments, cwd=self.work, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                 errors="replace", preexec_fn=cap, start_new_session=True)
        try:
            out, _ = child.communicate(timeout=WAITING * (limit + 30))
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)
            child.communicate()
            return "timeout", limit
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        if child.returncode == 0:
            return "passed", used
        if child.returncode == -signal.SIGXCPU or (child.returncode == -signal.SIGKILL and used >= limit):
            return "timeout", used
        failed = re.search(r"\[  FAILED  \] (\S+)", out)
        return failed.group(1).rstrip(",") if failed else f"crash, status {child.returncode}", used

    def limit_of(self, program: Program) -> float:
        """Runs the program once as it is: it must pass, and a mutant may take ten times the processor time [s]."""
        path, tests = self.build / "bin" / program.name, program.filter or "*"
        kept = self.work.parent / "limits.json"
        limits = json.loads(kept.read_text()) if kept.exists() else {}
        key = f"{program.name} {path.stat().st_mtime_ns} {tests}"
        if key not in limits:
            ended, used = self.run(path, tests, 600)
            if ended != "passed":
                raise SystemExit(f"{program.name} does not pass without a mutant: {ended}")
            limits = (json.loads(kept.read_text()) if kept.exists() else {}) | {key: 10 * used + 10}
            whole = self.work / "limits.json"
            whole.write_text(json.dumps(limits, indent=1))
            whole.rename(kept)  # another part may read it
        return limits[key]

    def verdict(self, path: Path, program: Program, killers: list[str]) -> str:
        """Returns how a mutant ended: first before the tests that killed others of its source, then before all."""
        limit, ended = self.limit_of(program), "passed"
        if killers:
            ended, _ = self.run(path, ":".join(killers), limit)
        return self.run(path, program.filter or "*", limit)[0] if ended == "passed" else ended

    def judge(self, source: str, text: str, programs: list[Program], killers: list[str]) -> tuple[str, str]:
        """Returns a verdict and its reason: killed, timeout, survived, same (equal machine code) or invalid."""
        every: dict[str, bytes] = {}
        for program in programs:
            objects = self.objects_of(source, program)
            for obj in objects:
                every[obj] = every.get(obj) or self.compiled(source, text, obj)
                if every[obj] is None:
                    return "invalid", ""
            if all(every[obj] == self.originals.get(obj) for obj in objects):
                continue
            path = self.linked(program, {obj: every[obj] for obj in objects})
            if path is None:
                return "invalid", ""
            ended = self.verdict(path, program, killers)
            if ended == "timeout":
                return "timeout", program.name
            if ended != "passed":
                return "killed", ended
        if not every:
            raise SystemExit(f"{source}: no program that targets.txt names for it is made of it")
        # Only now, because most are killed: the original takes as long to compile as the mutant.
        return ("survived" if any(held != self.original(source, obj) for obj, held in every.items()) else "same"), ""
