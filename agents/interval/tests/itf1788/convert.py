"""Converts the vectors of ITF1788 (https://github.com/oheim/ITF1788) into the plain-text files in `vectors`.

Usage: convert.py DIRECTORY-OF-ITL-FILES

One check a line, `operation operands = expected`, numbers as the source writes them. Comments, test-case names and what
only decorated intervals have are dropped. Only the files under permissive licences are converted; each keeps its notice.
"""

import pathlib
import re
import sys

FILES = """abs_rev atan2 ieee1788-constructors ieee1788-exceptions libieeep1788_bool libieeep1788_cancel libieeep1788_class
libieeep1788_elem libieeep1788_mul_rev libieeep1788_num libieeep1788_overlap libieeep1788_rec_bool libieeep1788_reduction
libieeep1788_rev libieeep1788_set pow_rev""".split()

# An interval, a set of numbers, a text, or a word; whatever follows an interval is its decoration.
TOKEN = re.compile(r'"[^"]*"|\[[^]]*\]\w*|\{[^}]*\}|[^\s\[{"]+')
DECORATED = re.compile(r"^\[.*\]_\w+$|^\[nai\]$")
FOR_DECORATED = re.compile(r"^(d-|newDec|setDec|decorationPart|intervalPart|isNaI)")


def tokens(text):
    return [token if token[0] == '"' else re.sub(r"\s", "", token) for token in TOKEN.findall(text)]


def checks(source):
    source = re.sub(r"/\*.*?\*/|//[^\n]*", "", source, flags=re.DOTALL)
    source = re.sub(r"testcase\s+\S+\s*\{(.*?)\n\}", r"\1", source, flags=re.DOTALL)
    for statement in source.split(";"):
        parts = tokens(statement)
        bare = not any(DECORATED.match(part) for part in parts)
        if parts and bare and not FOR_DECORATED.match(parts[0]):
            yield " ".join(parts)


def main(directory):
    vectors = pathlib.Path(__file__).parent / "vectors"
    for name in FILES:
        source = (pathlib.Path(directory) / f"{name}.itl").read_text(encoding="utf-8")
        notice = re.search(r"/\*(.*?)\*/", source, re.DOTALL).group(1).strip()
        origin = (
            f"itl/{name}.itl of ITF1788, https://github.com/oheim/ITF1788, reduced by convert.py to the checks of bare\n"
            "intervals, one a line. What follows is its notice; the Apache License is in LICENSE-APACHE, the authors in NOTICE.\n"
        )
        header = "\n".join(f"# {line}".rstrip() for line in f"{origin}\n{notice}".split("\n"))
        body = "\n".join(checks(source))
        (vectors / f"{name}.txt").write_text(f"{header}\n\n{body}\n", encoding="utf-8")


main(sys.argv[1])
