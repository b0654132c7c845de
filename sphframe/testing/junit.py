"""Testing: reports of the verification as JUnit XML, which continuous integration shows."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from xml.etree import ElementTree

from sphframe.testing.order import OrderReport
from sphframe.testing.verification import Report


def write_junit(reports: Sequence[Report | OrderReport], path: str | Path) -> None:
    """Write a test suite per component, with a test case per check or promised order.

    What is not declared counts as skipped.
    """
    root = ElementTree.Element("testsuites", name="sphframe verify")
    for report in reports:
        suite = ElementTree.SubElement(root, "testsuite", name=report.name)
        found = list(_cases(report))
        suite.set("tests", str(len(found)))
        for kind, heading in (("failure", "failures"), ("error", "errors"), ("skipped", "skipped")):
            suite.set(heading, str(sum(verdict == kind for _, verdict, _ in found)))
        for name, verdict, text in found:
            case = ElementTree.SubElement(suite, "testcase", classname=report.name, name=name)
            if verdict:
                outcome = ElementTree.SubElement(case, verdict, message=text.partition("\n")[0])
                outcome.text = None if verdict == "skipped" else text
    ElementTree.indent(root)
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


def _cases(report: Report | OrderReport) -> Iterator[tuple[str, str, str]]:
    """Yield name, element (none for what holds) and text of each test case."""
    if report.error is not None:
        yield "can be made", "error", report.error
    if isinstance(report, OrderReport):
        for operator, texts in report.by_promise().items():
            yield f"order of the {operator.replace('_', ' ')}", "failure" if texts else "", "\n".join(texts)
        return
    for result in report.results:
        if result.verdict == "broken":
            text = result.failure or f"it was expected to fail ({result.expected}), but holds"
            yield str(result.check), "failure", text
        elif result.verdict in ("absent", "expected"):
            yield str(result.check), "skipped", result.expected or "not declared"
        else:
            yield str(result.check), "", ""
