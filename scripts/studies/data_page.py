"""The page of docs/data/ that holds all tables of one study: each behind a fold, with the sentence that it tells."""

from __future__ import annotations

from collections.abc import Iterator

from scripts.studies.markdown_table import MarkdownTable
from scripts.studies.result import Result


def data_page(result: Result) -> str:
    """The page of the kept `result`: its question, how it is run again, its tables, what is told besides."""
    return "\n".join(parts_of(result))


def parts_of(result: Result) -> Iterator[str]:
    """The page, part by part."""
    study = result.study
    yield f"# {study.name}\n\n{study.question}\n"
    again = f"`retarder-synth study {study.name} --document` makes this page again in {study.duration}."
    page, _, anchor = study.page.partition("#")
    if page:
        link = f"../{page}#{anchor}" if anchor else f"../{page}"
        again += f" What it means: [{page.rpartition('/')[2].removesuffix('.md').replace('-', ' ')}]({link})."
    yield f"{again}\n"
    for name, each in result.findings.tables().items():
        yield folded(name, each)
    told = (*result.findings.sentences(), *result.findings.faults())
    if told:
        yield "".join(f"- {sentence}\n" for sentence in told)


def folded(name: str, each: MarkdownTable) -> str:
    """The heading `name`, the sentence of the table, and the table behind it."""
    return f"## {name}\n\n<details>\n<summary>{each.title}</summary>\n\n{each.markdown()}\n</details>\n"
