#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that ./dev installs every package that the build, the program and the scripts use.

usage: packages_listed.py SOURCE_DIR BUILD_DIR

Headers come from the dependency records of the build, libraries from ldd, Python modules from the imports of our
scripts. Each file must belong to a package of the list in ./dev, to one that these depend on, or to the base
system. Exit code 77 (skipped) where there is no dpkg.
"""
import ast
import importlib.util
import pathlib
import re
import shutil
import subprocess
import sys

BASE_PRIORITIES = {"required", "important"}
PROGRAMS = ["g++", "cmake", "ctest", "ninja", "git"]


def output(*command):
    return subprocess.run(command, check=False, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout


def listed_packages(source):
    return output(source / "dev", "packages").split()


def installed_packages():
    """name -> (dependencies, each a list of alternatives; what it provides; is it part of the base system)."""
    fields = "${Package}\t${Pre-Depends}, ${Depends}\t${Provides}\t${Priority}\t${Essential}\t${db:Status-Status}\n"
    packages = {}
    for line in output("dpkg-query", "-W", "-f", fields).splitlines():
        name, depends, provides, priority, essential, status = line.split("\t")
        if status != "installed":
            continue
        needs = [[re.split(r"[\s(:]", choice.strip())[0] for choice in group.split("|")]
                 for group in depends.split(",") if group.strip()]
        provided = [re.split(r"[\s(]", item.strip())[0] for item in provides.split(",")]
        packages[name] = (needs, provided, essential == "yes" or priority in BASE_PRIORITIES)
    return packages


def closure(roots, packages):
    """The roots and what they depend on: of alternatives the first that is installed, as apt would choose.

    The other installed alternatives are added at the end without their own dependencies: update-alternatives may
    have put one of them in place (the BLAS, for example).
    """
    providers = {}
    for name, (_, provided, _) in packages.items():
        for item in provided:
            providers.setdefault(item, []).append(name)
    found, others, open_names = set(), set(), list(roots)
    while open_names:
        name = open_names.pop()
        if name not in packages or name in found:
            continue
        found.add(name)
        for group in packages[name][0]:
            real = [choice for choice in group if choice in packages]
            virtual = [provider for choice in group for provider in providers.get(choice, [])]
            open_names += (real + virtual)[:1]
            others.update(real + virtual)
    return found | others


def headers(source, build):
    """System headers that the build has read."""
    paths = set()
    for line in output("ninja", "-C", build, "-t", "deps").splitlines():
        path = line.strip()
        if line.startswith("    /") and not path.startswith((f"{source}/", f"{build}/")):
            paths.add(path)
    return paths


def libraries(build):
    binaries = [build / "meltray", *(p for p in (build / "tests").glob("test_*") if p.suffix == "")]
    binaries = [p for p in binaries if p.is_file()]
    return {path for binary in binaries for path in re.findall(r"=> (/\S+)", output("ldd", binary))}


def python_modules(source):
    """Third-party and standard modules that our scripts import, as files."""
    names, paths = set(), set()
    scripts = [p for folder in ("scripts", "tests", "validation") for p in (source / folder).rglob("*.py")]
    own = {p.stem for p in scripts}
    for script in scripts:
        for node in ast.walk(ast.parse(script.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                names |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
                names.add(node.module.split(".")[0])
    for name in names - own:
        spec = importlib.util.find_spec(name)
        if spec is None:
            paths.add(f"(Python module {name}, not installed)")
        elif spec.origin and spec.origin.startswith("/"):
            paths.add(spec.origin)
    return paths


def owners(paths):
    """path -> package that owns it, None if no package does."""
    candidates = {}  # what dpkg may know the file as -> the path as it was used
    for path in paths:
        real = str(pathlib.Path(path).resolve())
        for name in (path, real):
            candidates[name] = path
            # /lib is /usr/lib, but dpkg remembers the name that the package used
            candidates[name.removeprefix("/usr") if name.startswith("/usr/") else "/usr" + name] = path
    found = dict.fromkeys(paths)
    for line in output("dpkg-query", "-S", *candidates).splitlines():
        package, _, name = line.rpartition(": ")
        if name in candidates and not package.startswith("diversion by"):
            found[candidates[name]] = package.split(",")[0].split(":")[0]
    return found


def main():
    source, build = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    if shutil.which("dpkg-query") is None:
        print("no dpkg here: skipped")
        return 77
    packages = installed_packages()
    listed = listed_packages(source)
    allowed = closure(listed, packages) | {name for name, (_, _, base) in packages.items() if base}
    used = {"header": headers(source, build), "library": libraries(build), "module": python_modules(source),
            "program": {f"/usr/bin/{p}" for p in PROGRAMS}}
    failures = [f"{name}: in the list of ./dev but not installed" for name in listed if name not in packages]
    for kind, paths in used.items():
        if not paths:
            failures.append(f"no {kind} found at all: is {build} built?")
        for path, package in sorted(owners(paths).items()):
            if package not in allowed:
                failures.append(f"{kind} {path}: package {package or 'unknown'} is not installed by ./dev")
        print(f"{len(paths)} {kind} files looked at")
    print("\n".join(failures) or f"all belong to the {len(listed)} listed packages or to what they depend on")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
