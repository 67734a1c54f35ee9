"""What mobile compilers say of the segment shaders, as one self-contained HTML page."""

import mobile_plots as plots
from mobile_data import KINDS
from page_html import (MISSING, card, cards, command, device_facts, document, esc, facts, figure, figures, masthead,
                       plural, section, table as html_table)
from page_input import number

HEADLINE = "16, post, proximity"


def short(row):
    """Its cost, with what makes it: waits of an Adreno, the texture unit of a Mali."""
    if row is None or row.cost is None:
        return MISSING
    if "sy" in row.figures:
        return f"{figures(row.cost)} <i>{row.figures['sy']:.0f} (sy)</i>"
    return f"{figures(row.cost)} <i>{figures(row.figure('texture'))} t</i>"


def head(table):
    found = []
    for gpu, about in table.gpus.items():
        now, before = table.cell(gpu, HEADLINE, "general"), table.cell(gpu, HEADLINE, "before")
        if now is None or now.cost is None:
            continue
        unit = "cycles" if table.is_mali(gpu) else "instructions"
        was = f"{HEADLINE}; before: {figures(before.cost)}" if before is not None and before.cost else HEADLINE
        found.append(card(about["title"], f"{figures(now.cost)} {unit}", f"a fragment of {was}", "skips"))
    failed = sum(row.cost is None for row in table.rows)
    line = (f"{plural(len({row.variant for row in table.rows}), 'variant')} of the segment shader, "
            f"{plural(len(table.gpus), 'compiler')}")
    words = ("<p>Compilers say what code they made, not how long a device takes over it: nothing was drawn and nothing "
             "timed. A Mali’s units run side by side, so that the busiest is the cost, in cycles of one core per "
             "fragment; its texture cycles know neither three dimensions nor wide formats, which cost double each on "
             "the device. Of an Adreno a fragment’s instructions are counted, with the (sy) waits, each a stall for a "
             "fetch.</p>")
    if failed:
        words += f"<p>{plural(failed, 'row')} could not be compiled; the table says why.</p>"
    return masthead("mobile compilers", "What does a fragment cost on a phone’s GPU?", line, {}, words + cards(found))


def compared(table):
    columns = [(gpu, column) for gpu in table.gpus for column in KINDS
               if any(table.cell(gpu, name, column) is not None for name, _ in table.named)]
    rows = [[esc(name), *(short(table.cell(gpu, name, column)) for gpu, column in columns)] for name, _ in table.named]
    heads = ["a fragment of", *(f"{esc(table.gpus[gpu]['title'])} <i>{KINDS[column]}</i>" for gpu, column in columns)]
    return html_table(heads, rows, css="rows") if columns else ""


def cache_words(size, cache):
    """Whether so many bytes of code stay in the GPU's cache of instructions."""
    if number(cache) is None:
        return "not published"
    return f"{cache / 1024:.3g} KiB: {'fits' if size <= cache else f'{size / cache:.1f} times over'}"


def room(row):
    """Registers that it takes, and how many fragments are under way beside it."""
    said = [f"{row.figure(name):.0f} {words}" for name, words in (("full_registers", "full"), ("half_registers", "half"))
            if row.figure(name) is not None]
    said += [plural(int(row.figure(name)), name[:-1]) for name in ("threads", "waves") if row.figure(name) is not None]
    return ", ".join(said) or MISSING


def resources(table):
    """What a fragment holds on to, of every named row as it is now."""
    rows = []
    for gpu, about in table.gpus.items():
        for name, labels in table.named:
            row = table.cell(gpu, name, "general")
            if row is None or row.cost is None:
                continue
            size = row.figure("code_bytes") or 16 * (row.figure("quadwords") or 0)
            spilled = f"{figures(row.figure('spills'))} : {figures(row.figure('fills'))}"
            rows.append([f"{esc(about['title'])} <i>{esc(name)}</i>", room(row), spilled, f"{size / 1024:.1f}",
                         cache_words(size, about.get("cache_bytes")), f"<code>{esc(labels['general'])}</code>"])
    heads = ["registers and code of", "room", "spills : fills", "code, KiB", "instruction cache",
             "variant"]
    return html_table(heads, rows, css="rows") if rows else ""


def failures(table):
    reasons = {}
    for row in table.rows:
        if row.cost is None:
            about = reasons.setdefault((row.gpu, row.failed.split(": ", 1)[-1]), [])
            about.append(row.variant)
    rows = [[esc(table.gpus[gpu]["title"]), str(len(variants)), f"{esc(why)} <i>as {esc(variants[0])}</i>"]
            for (gpu, why), variants in reasons.items()]
    return html_table(["not compiled", "variants", "why"], rows, css="rows") if rows else ""


def run_facts(table):
    about = [(about["title"], esc(about.get("mesa", ""))) for about in table.gpus.values()]
    return facts([*device_facts(table.raw), *about]) + command(table.raw)


def page(table):
    sections = [
        section("Before and after", compared(table)),
        section("A layer", figure(plots.per_layer, table, "A fragment’s cost over the layers that it composites: what "
                                  "setting a segment up costs is shared out. Only forms that are written out.")),
        section("What is busy", figure(plots.units, table, "Of a Mali the two units that may be busiest, of an Adreno "
                                       "instructions. A line marks the whole cost before.")),
        section("Registers and code", resources(table)),
        section("Not compiled", failures(table)),
        section("This run", run_facts(table)),
    ]
    return document("Mobile compilers", head(table), sections)
