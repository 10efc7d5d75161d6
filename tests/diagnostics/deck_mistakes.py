"""Makes one mistake in a deck at a time and says what a good error message has to name.

Places come from PyYAML's node marks, so keys of block and flow mappings are treated alike.
"""
import re
from dataclasses import dataclass, field

import yaml

NUMBER = re.compile(r"^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$")
QUANTITY = re.compile(r"^([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s+([A-Za-z%][\w/%*^ ]*)$")


@dataclass
class Mistake:
    kind: str            # misspelt, type, unit, range, choice, missing, duplicate
    path: str            # such as bodies[0].shape.radius
    text: str            # the whole deck with the mistake
    lines: tuple         # lines (from 1) that the first error may name
    suggestion: str = ""  # the name that the message has to offer; empty: none


@dataclass
class Entry:
    """A key of the deck with its value, its mapping, and what the JSON Schema says of it."""
    path: str
    key: yaml.Node
    value: yaml.Node
    mapping: yaml.MappingNode
    place: int           # line of the mapping's own key or list item
    schemas: list = field(default_factory=list)   # for the value
    required: bool = False
    free: bool = False   # the name is the author's own (a variable)


def line(node):
    return node.start_mark.line + 1


def last_index(node):
    """Where the node's text ends; a block collection's own mark lies behind blank lines and comments."""
    if isinstance(node, yaml.ScalarNode) or node.flow_style:
        return node.end_mark.index
    parts = [p for pair in node.value for p in pair] if isinstance(node, yaml.MappingNode) else node.value
    return max((last_index(p) for p in parts), default=node.end_mark.index)


class SchemaWalk:
    """Finds the sub-schemas that hold for a node: follows $ref, allOf, anyOf and oneOf, and takes of
    several alternatives those that fit the node's `type`."""

    def __init__(self, schema):
        self.root = schema or {}

    def flat(self, schema):
        if not isinstance(schema, dict):
            return
        if "$ref" in schema:
            target = self.root
            for part in schema["$ref"].lstrip("#/").split("/"):
                target = target[part.replace("~1", "/").replace("~0", "~")]
            yield from self.flat(target)
        yield schema
        for word in ("allOf", "anyOf", "oneOf"):
            for part in schema.get(word, []):
                yield from self.flat(part)

    def fitting(self, schemas, node):
        """The object schemas among these that fit the mapping's `type:`."""
        chosen = {k.value: v.value for k, v in node.value if isinstance(v, yaml.ScalarNode)}.get("type")
        for schema in (s for start in schemas for s in self.flat(start)):
            allowed = schema.get("properties", {}).get("type", {})
            names = allowed.get("enum", [allowed["const"]] if "const" in allowed else None)
            if "properties" in schema and (names is None or chosen in names):
                yield schema


def entries(text, schema):
    """Every key of the deck. x- keys are the author's notes and left out."""
    walk = SchemaWalk(schema)

    def visit(node, schemas, path, place, free):
        if isinstance(node, yaml.MappingNode):
            fitting = list(walk.fitting(schemas, node))
            for key, value in node.value:
                if key.value.startswith("x-") or value.start_mark.index < key.start_mark.index:
                    continue   # an alias stands where its anchor is
                inner = [s["properties"][key.value] for s in fitting if key.value in s["properties"]]
                name = f"{path}.{key.value}" if path else key.value
                yield Entry(name, key, value, node, place, inner,
                            any(key.value in s.get("required", []) for s in fitting), free)
                yield from visit(value, inner, name, line(key), name == "variables")
        elif isinstance(node, yaml.SequenceNode):
            items = [s["items"] for start in schemas for s in walk.flat(start) if "items" in s]
            for i, item in enumerate(node.value):
                yield from visit(item, items, f"{path}[{i}]", line(item), False)

    root = yaml.compose(text, Loader=yaml.SafeLoader)
    for entry in visit(root, [walk.root], "", 1, False):
        entry.schemas = [s for start in entry.schemas for s in walk.flat(start)]
        yield entry


def typos(name):
    """One-letter mistakes in a name, the likeliest to be told apart first for its length."""
    middle = len(name) // 2
    doubled = name[:middle] + name[middle] + name[middle:]
    if len(name) < 4:
        return [doubled, name + "q"]
    dropped = name[:middle] + name[middle + 1:]
    swapped = name[:middle - 1] + name[middle] + name[middle - 1] + name[middle + 1:]
    replaced = name[:middle] + "q" + name[middle + 1:]
    forms = [dropped, swapped, replaced, doubled]
    turn = sum(map(ord, name)) % len(forms)
    return [t for t in forms[turn:] + forms[:turn] if t != name]


def key_names(schema):
    """All key names anywhere in a JSON Schema."""
    if isinstance(schema, dict):
        properties = schema.get("properties", {})
        return set(properties) | {n for part in schema.values() for n in key_names(part)}
    if isinstance(schema, list):
        return {n for part in schema for n in key_names(part)}
    return set()


def mistakes(text, schema):
    """Every mistake this module knows, for every key of the deck."""
    known = key_names(schema)
    for entry in entries(text, schema):
        yield from misspelt(text, entry, known)
        if entry.free:
            continue
        yield from wrong_type(text, entry)
        yield from wrong_number(text, entry)
        yield from wrong_choice(text, entry)
        yield from missing(text, entry)
        yield from duplicate(text, entry)


def spliced(text, start, end, new):
    return text[:start] + new + text[end:]


def misspelt(text, entry, known):
    name = entry.key.value
    wrong = next(t for t in typos(name) if t not in known)
    start, end = entry.key.start_mark.index, entry.key.end_mark.index
    changed = spliced(text, start, end, wrong)
    if not entry.free:
        yield Mistake("misspelt", entry.path, changed, (line(entry.key),), name)
        return
    # A variable's definition: the formulas that use it go wrong, wherever they stand.
    word = re.compile(rf"(?<![\w.]){re.escape(name)}(?!\w|\s*:)")
    bare = [re.sub(r"(^|\s)#.*", "", l) for l in changed.splitlines()]
    uses = tuple(i for i, l in enumerate(bare, 1) if word.search(re.sub(r"^[^:{]*:", "", l)))
    if uses:
        yield Mistake("misspelt", entry.path, changed, uses, wrong)


def wrong_type(text, entry):
    value = entry.value
    new = "17" if isinstance(value, yaml.MappingNode) else "{wrong: type}"
    end = last_index(value)
    # What a block collection leaves behind on its first line is only the line break.
    before = text[:entry.key.end_mark.index] + ": "
    yield Mistake("type", entry.path, before + new + text[end:], (line(entry.key),))


def numbers(entry):
    """The first number of the value: the scalar itself or the first of a flow list."""
    value = entry.value
    if isinstance(value, yaml.SequenceNode) and value.value:
        value = value.value[0]
    if isinstance(value, yaml.ScalarNode) and value.style is None:
        if NUMBER.match(value.value) or QUANTITY.match(value.value):
            return value
    return None


def wrong_number(text, entry):
    node = numbers(entry)
    if node is None:
        return
    start, end = node.start_mark.index, node.end_mark.index
    lines = (line(node), line(entry.key))
    found = QUANTITY.match(node.value)
    number = found.group(1) if found else node.value
    unit = "s" if "mass" in entry.key.value or (found and found.group(2) == "kg") else "kg"
    yield Mistake("unit", entry.path, spliced(text, start, end, f"{number} {unit}"), lines)
    yield Mistake("range", entry.path, spliced(text, start, end, ".inf"), lines)
    if entry.value is not node:
        return
    low = [s[k] for s in entry.schemas for k in ("minimum", "exclusiveMinimum") if k in s]
    high = [s[k] for s in entry.schemas for k in ("maximum", "exclusiveMaximum") if k in s]
    for outside in [min(low) - 1] if low else []:
        yield Mistake("range", entry.path, spliced(text, start, end, f"{outside:g}"), lines)
    for outside in [max(high) + 1] if high else []:
        yield Mistake("range", entry.path, spliced(text, start, end, f"{outside:g}"), lines)


def wrong_choice(text, entry):
    choices = {c for s in entry.schemas for c in s.get("enum", [s["const"]] if "const" in s else [])
               if isinstance(c, str)}
    value = entry.value
    if not isinstance(value, yaml.ScalarNode) or value.value not in choices:
        return
    # A formula is also allowed there: the mistyped word is then an unknown name in it.
    wrong = next(t for t in typos(value.value) if t not in choices)
    changed = spliced(text, value.start_mark.index, value.end_mark.index, wrong)
    yield Mistake("choice", entry.path, changed, (line(value),), value.value)


def missing(text, entry):
    if not entry.required:
        return
    pairs = entry.mapping.value
    at = next(i for i, (key, _) in enumerate(pairs) if key is entry.key)
    start, end = entry.key.start_mark.index, last_index(entry.value)
    lines = {entry.place, line(pairs[0][0]), line(entry.mapping)}
    if entry.mapping.flow_style:
        if at + 1 < len(pairs):
            end = pairs[at + 1][0].start_mark.index
        elif at > 0:
            start = last_index(pairs[at - 1][1])
    elif len(pairs) == 1:
        return   # an empty block mapping is no mapping at all: a wrong type, not a missing key
    elif at + 1 < len(pairs):
        end = pairs[at + 1][0].start_mark.index   # the next key moves up into this one's place
    if not entry.path.count(".") and "[" not in entry.path:
        lines |= set(range(1, line(pairs[0][0]) + 1))
    yield Mistake("missing", entry.path, spliced(text, start, end, ""), tuple(sorted(lines)))


def duplicate(text, entry):
    start, end = entry.key.start_mark.index, last_index(entry.value)
    copy = text[start:end]
    if entry.mapping.flow_style:
        changed = spliced(text, end, end, ", " + copy)
        where = line(entry.key) + copy.count("\n")
    else:
        # Behind the rest of the value's last line, which may hold a comment.
        stop = text.find("\n", end)
        stop = len(text) if stop < 0 else stop
        changed = spliced(text, stop, stop, "\n" + " " * entry.key.start_mark.column + copy)
        where = text.count("\n", 0, stop) + 2
    yield Mistake("duplicate", entry.path, changed, (where,))
