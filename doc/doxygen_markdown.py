#!/usr/bin/env python3
"""Filter of doc/Doxyfile: prints a Markdown page with headings and links as Doxygen wants them.

GitHub makes an anchor of each heading, which is unique in its page, and takes links relative to the
page. Doxygen wants anchors that are unique in all pages, and knows no files but those that it reads.
"""
import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = ROOT / "build" / "doc" / "html"  # where links start


def anchor_of(heading):
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", text).lower().strip().replace(" ", "-")


def label(page, anchor):
    return f"{page.stem.lower()}_{anchor}"


class Links:
    def __init__(self, page):
        self.page = page

    def replace(self, match):
        mark, text, link = match.groups()
        if mark or re.match(r"\w+://", link):
            return match.group()
        file, _, anchor = link.partition("#")
        target = (self.page.parent / file).resolve() if file else self.page
        if target.suffix == ".md" and anchor:
            return f"[{text}](#{label(target, anchor)})"
        if target.suffix == ".md":
            return f"[{text}](#{label(target, 'page')})"
        # One line of a file is what GitHub shows, not what a browser can go to.
        return f'<a href="{os.path.relpath(target, PAGES)}">{text.replace("`", "")}</a>'


def filtered(page):
    links, code, lines = Links(page), False, []
    text = page.read_text(encoding="utf-8")
    # A link's text may go over the end of a line.
    parts = re.split(r"(^```.*?^```)", text, flags=re.MULTILINE | re.DOTALL)
    for part in parts:
        code = part.startswith("```")
        if not code:
            part = re.sub(r"(!?)\[([^\]\[]+)\]\(([^)\s]+)\)", links.replace, part)
            part = re.sub(r"^# (.*)$", lambda m: f"# {m.group(1)} {{#{label(page, 'page')}}}", part,
                          flags=re.MULTILINE)
            part = re.sub(r"^(##+) (.*)$",
                          lambda m: f"{m.group(1)} {m.group(2)} {{#{label(page, anchor_of(m.group(2)))}}}",
                          part, flags=re.MULTILINE)
        lines.append(part)
    return "".join(lines)


if __name__ == "__main__":
    sys.stdout.write(filtered(pathlib.Path(sys.argv[1]).resolve()))
