"""Stability cases as the page needs them: read, checked, in families and by reason."""

import math
from dataclasses import dataclass
from pathlib import Path

import page_input
from page_input import BadInput, number

SHARED = 3  # so many cases of one reason have it stated once


@dataclass(eq=False)
class Case:
    raw: dict
    family: str
    name: str
    quantity: str
    reason: str
    bound: float
    measured: float  # None where it is no number, or nothing could be measured
    passed: bool
    failure: str

    @property
    def share(self):
        """Of the bound; infinite beyond a bound of zero, None where nothing was measured."""
        if self.measured is None:
            return None
        if self.bound > 0:
            return max(0.0, self.measured / self.bound)
        return 0.0 if self.measured <= self.bound else math.inf

    def extra(self, name):
        return page_input.section(self.raw, name)


@dataclass
class Family:
    name: str
    title: str
    cases: list

    @property
    def failed(self):
        return [case for case in self.cases if not case.passed]


def by_reason(cases):
    """[(reason, cases)] for each reason that many share, then (None, the other cases)."""
    alike = {}
    for case in cases:
        alike.setdefault(case.reason, []).append(case)
    shared = [(reason, members) for reason, members in alike.items() if reason and len(members) >= SHARED]
    rest = [case for case in cases if not case.reason or len(alike[case.reason]) < SHARED]
    return shared + ([(None, rest)] if rest else [])


@dataclass
class Stability:
    raw: dict
    folder: Path
    families: list

    @property
    def cases(self):
        return [case for family in self.families for case in family.cases]

    @property
    def failed(self):
        return [case for case in self.cases if not case.passed]

    def title_of(self, name):
        return next(family.title for family in self.families if family.name == name)


def _case(raw, where):
    again = "run `slabcast stability` again"
    for name in ("family", "name"):
        if not isinstance(raw.get(name), str) or not raw[name]:
            raise BadInput(f"{where}.{name} is no text; {again}")
    bound = number(raw.get("bound"))
    if bound is None or bound < 0:
        raise BadInput(f"{where}.bound is no number from 0 on; {again}")
    if not isinstance(raw.get("pass"), bool):
        raise BadInput(f"{where}.pass is neither true nor false; {again}")
    measured = raw.get("measured")
    if measured is not None and number(measured) is None:
        raise BadInput(f"{where}.measured is no number; {again}")
    failure = str(raw.get("failure") or "")
    return Case(raw, raw["family"], raw["name"], str(raw.get("quantity", "")), str(raw.get("reason", "")), bound,
                None if failure else number(measured), raw["pass"], failure)


def load(folder):
    """DIR/stability.json. Raises BadInput."""
    path, raw = page_input.read(folder, "stability.json", "cases", "stability")
    cases = [_case(case, f"{path}: cases[{i}]") for i, case in enumerate(raw["cases"])]
    listed = raw.get("families") if isinstance(raw.get("families"), list) else []
    titles = {family["name"]: str(family.get("title", family["name"]))
              for family in listed if isinstance(family, dict) and isinstance(family.get("name"), str)}
    for case in cases:
        titles.setdefault(case.family, case.family)
    families = [Family(name, title, [case for case in cases if case.family == name]) for name, title in titles.items()]
    return Stability(raw, Path(folder), [family for family in families if family.cases])
