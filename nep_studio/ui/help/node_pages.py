"""The page of a node, made from its manifest: what it does, its settings, its topics."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape

from nep_core.errors import ManifestError
from nep_core.manifest import Manifest, NodeCatalog, Parameter, read_manifest
from nep_core.places import node_folders
from nep_studio.help.markdown import code_html, inline
from nep_studio.help.texts import node_texts
from nep_studio.ui.words import language_code, tr


def manifests() -> Mapping[str, Manifest]:
    """The manifests of all nodes that can be launched, by id; wrong ones are left out."""
    found: dict[str, Manifest] = {}
    for path in NodeCatalog(node_folders()).paths():
        try:
            manifest = read_manifest(path)
        except ManifestError:
            continue  # its problem is told where it is launched
        found.setdefault(manifest.id, manifest)
    return found


def node_title(manifest: Manifest, titles: Mapping[str, str]) -> str:
    """What a node is called; ``titles`` are those in the language in use."""
    return titles.get(manifest.id) or tr(manifest.title)


def node_html(manifest: Manifest, title: str) -> str:
    """The page of a node."""
    told = node_texts(language_code()).get(manifest.id, "")
    parts = [
        f"<h1>{escape(title)}</h1>",
        f"<p>{inline(told or tr(manifest.description))}</p>",
        f"<p>{escape(_type(manifest.type))}</p>",
        _settings(manifest),
        _topics(manifest),
        f"<h2>{escape(tr('In a terminal'))}</h2>",
        code_html(f"nep-studio node {manifest.id}"),
    ]
    return "\n".join(part for part in parts if part)


def _type(name: str) -> str:
    return {
        "sensory": tr("It measures: it publishes what a sensor says."),
        "perceptual": tr("It recognises: it turns measurements into human states."),
        "cognitive": tr("It decides: it runs a program."),
        "action": tr("It acts: it moves a robot."),
    }[name]


def _settings(manifest: Manifest) -> str:
    if not manifest.parameters:
        return ""
    heads = (tr("Setting"), tr("What it is"), tr("Usually"))
    head = "".join(f"<th>{escape(words)}</th>" for words in heads)
    rows = "".join(_row(name, each) for name, each in manifest.parameters.items())
    return (
        f"<h2>{escape(tr('Its settings'))}</h2>"
        f'<table class="table" width="100%" cellspacing="0"><tr>{head}</tr>{rows}</table>'
    )


def _row(name: str, parameter: Parameter) -> str:
    usual = parameter.default
    if parameter.required:
        shown = tr("must be given")
    elif isinstance(usual, bool):
        shown = tr("on") if usual else tr("off")
    else:
        shown = "" if usual in ("", None) else f"{usual:g}" if _is_number(usual) else str(usual)
    told = "<br>".join(escape(part) for part in (tr(parameter.help), _limits(parameter)) if part)
    return (
        f'<tr><td><a name="setting-{name}"></a><b>{escape(name)}</b></td>'
        f"<td>{told}</td><td>{escape(shown)}</td></tr>"
    )


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _limits(parameter: Parameter) -> str:
    if parameter.choices:
        return ", ".join(parameter.choices)
    if parameter.minimum is not None and parameter.maximum is not None:
        low, high = f"{parameter.minimum:g}", f"{parameter.maximum:g}"
        return tr("{kind} from {low} to {high}", kind=tr("a number"), low=low, high=high)
    return ""


def _topics(manifest: Manifest) -> str:
    """What it hears and says."""
    lines = []
    if manifest.hears:
        lines.append(tr("It hears: {topics}", topics=", ".join(manifest.hears)))
    if manifest.says:
        lines.append(tr("It says: {topics}", topics=", ".join(manifest.says)))
    items = "".join(f"<li>{escape(line)}</li>" for line in lines)
    return f"<h2>{escape(tr('Its topics'))}</h2><ul>{items}</ul>" if items else ""
