#!/usr/bin/env python3
"""The pages are true as far as a program can tell: links lead somewhere, the sources that they and comments name exist, the walks of
architecture.md are as the code is, its tables of rooms are as those of ci/check-layers, and each scene has its figures in ps3.md.

    check_pages.py [--links] ROOT

With --links only the links, for pages that were installed.
"""
import pathlib
import re
import sys

MOST_FILES_OF_A_WALK = 5


def pages(root):
    return sorted([*root.glob("*.md"), *root.glob("docs/**/*.md"), *root.glob("examples/**/*.md")])


def without_code(text):
    return re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)


def anchors(page):
    """As GitHub makes them of headings."""
    headings = re.findall(r"^#+ (.*)$", without_code(page.read_text()), flags=re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def broken_links(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", without_code(page.read_text())):
        if "://" in target:
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        if not file.exists():
            yield f"{page}: the link {target} leads to no file"
        elif anchor and anchor not in anchors(file):
            yield f"{page}: the link {target} leads to no heading of {file.name}"


def missing_pages(root):
    """Of files that name a page: sources, scripts."""
    folders = [root / name for name in ("base", "ci", "cmake", "demos", "dma", "examples", "ls_sim", "ppu", "render", "spu_kernels", "tests", "tool")]
    for file in [*root.glob("*"), *(file for folder in folders for file in folder.rglob("*"))]:
        if not file.is_file() or file.suffix in (".png", ".rec"):
            continue
        for name in re.findall(r"\bdocs/[a-z0-9/-]+\.md\b", file.read_text(errors="ignore")):
            if not (root / name).exists():
                yield f"{file.relative_to(root)}: {name} is no page"


def missing_sources(root):
    """Of pages that name a source by its last folders: `obstacles/obstacle.h`."""
    folders = [root / name for name in ("base", "ci", "demos", "dma", "examples", "ls_sim", "ppu", "render", "spu_kernels", "tests", "tool")]
    known = ["/" + str(file.relative_to(root)) for folder in folders for file in folder.rglob("*.*")]
    for page in pages(root):
        for name in sorted(set(re.findall(r"`([\w/]+/\w+\.(?:h|cpp|def|py|toml|lua))`", without_code(page.read_text())))):
            if not any(file.endswith("/" + name) for file in known):
                yield f"{page.relative_to(root)}: {name} is no file"


def missing_sources_of_comments(root):
    """Of comments that name a source by its folders: `obstacles/obstacle.h`. The comments of kernels are left alone, as executables state the hash of these sources."""
    of_others = {"GL/osmesa.h"}
    folders = [root / name for name in ("base", "demos", "dma", "examples", "ls_sim", "ppu", "render", "spu_kernels", "tests", "tool")]
    files = [file for folder in folders for file in folder.rglob("*.*")]
    known = ["/" + str(file.relative_to(root)) for file in files]
    for file in files:
        if file.suffix not in (".h", ".cpp", ".def") or file.is_relative_to(root / "spu_kernels"):
            continue
        comments = " ".join(re.findall(r"^(?!\s*#).*?//(.*)$", file.read_text(errors="ignore"), flags=re.M))
        for name in sorted(set(re.findall(r"(?<![\w/.<-])\w+(?:/\w+)+\.(?:h|cpp|def)\b", comments)) - of_others):
            if not any(path.endswith("/" + name) for path in known):
                yield f"{file.relative_to(root)}: {name}, in a comment, is no file"


def wrong_walks(root):
    text = (root / "docs/reference/architecture.md").read_text()
    part = text[text.index("## Walks through the code\n"):]
    part = part[:part.index("\n## ", 1)]
    walks = re.split(r"^### ", part, flags=re.M)[1:]
    if len(walks) < 4:
        yield "architecture.md: fewer walks than the four that it had"
    for walk in walks:
        title, _, body = walk.partition("\n")
        steps = re.findall(r"^\d+\. `([^`]+)`(.*?)(?=^\d+\. |\Z)", body, flags=re.M | re.S)
        if not 1 <= len(steps) <= MOST_FILES_OF_A_WALK:
            yield f"architecture.md, '{title}': {len(steps)} files; a walk has 1 to {MOST_FILES_OF_A_WALK}"
        for file, sentence in steps:
            if not (root / file).is_file():
                yield f"architecture.md, '{title}': {file} is no file"
                continue
            source = (root / file).read_text()
            for name in re.findall(r"`(?:\w+(?:::|\.))*(\w+)\(\)`", sentence):
                if not re.search(rf"\b{name}\b", source):
                    yield f"architecture.md, '{title}': {file} has no {name}()"


def wrong_rooms(root):
    page = (root / "docs/reference/architecture.md").read_text()
    layers = (root / "ci/check-layers").read_text()
    page_has = set(re.findall(r"^\| `((?:ls_sim|demos|tool)/src/\w+)` \|", page, flags=re.M))
    layers_have = set(re.findall(r"^  \[((?:ls_sim|demos|tool)/src/\w+)\]=", layers, flags=re.M))
    for room in sorted(page_has ^ layers_have):
        yield f"{room} has a row in {'architecture.md' if room in page_has else 'ci/check-layers'} only"

    table = page[page.index("### The rooms of ppu\n"):]
    table = table[:table.index("\n\n", table.index("\n|"))]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines() if line.startswith("| `")]
    page_says = {row[0].strip("`"): set(re.findall(r"`(\w+)`", row[3])) for row in rows}
    of_ppu = re.search(r"^ppu_rooms='\n(.*?)^'", layers, flags=re.M | re.S).group(1)
    layers_say = {row.split()[0]: set(row.split()[1].split("|")) - {"-"} for row in of_ppu.splitlines()}
    for room in sorted(page_says.keys() | layers_say.keys()):
        if page_says.get(room) != layers_say.get(room):
            yield (f"the room ppu/{room} includes {sorted(page_says.get(room, []))} in architecture.md, "
                   f"{sorted(layers_say.get(room, []))} in ci/check-layers")


def missing_scenes(root):
    """Scenes without a row in the table of ci/ps3-figures, and rows of no scene."""
    page = root / "docs/notes/ps3.md"
    rows = set(re.findall(r"^\| `(\w+)` \|", page.read_text(), re.M))
    scenes = {file.stem for file in (root / "demos/scenes").iterdir() if file.suffix in (".toml", ".lua")}
    wrong = [f"docs/notes/ps3.md: has no row of the scene {scene}; `ci/ps3-figures {scene}` prints it" for scene in scenes - rows]
    return sorted(wrong + [f"docs/notes/ps3.md: there is no scene {row}" for row in rows - scenes])


def main():
    root = pathlib.Path(sys.argv[-1]).resolve()
    wrong = [sentence for page in pages(root) for sentence in broken_links(page)]
    if "--links" not in sys.argv:
        wrong += missing_pages(root)
        wrong += missing_sources(root)
        wrong += missing_sources_of_comments(root)
        wrong += wrong_walks(root)
        wrong += wrong_rooms(root)
        wrong += missing_scenes(root)
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
