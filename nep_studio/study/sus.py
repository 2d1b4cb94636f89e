"""The System Usability Scale: its items and its score, as in the paper and as Brooke made it.

Source: J. Brooke, "SUS: a quick and dirty usability scale", in P. W. Jordan et al. (eds.),
Usability Evaluation in Industry, Taylor & Francis 1996, pp. 189-194. Odd items are told in favour
of the thing that is judged, even items against it. Brooke gives five options; an answer is worth
0 to 4: for odd items the option less 1, for even items 5 less the option. The sum, 0 to 40, times
2.5 is a score from 0 to 100.

The paper (section "Evaluation of End-user Programming Interface", table "Subjective Satisfaction
Scores") has seven options and words after K. Finstad, "The System Usability Scale and non-native
English speakers", Journal of Usability Studies 1 (2006) 185-188, and does not write its formula
down. The same way of counting with k options makes an answer worth 0 to k - 1, and

    score = 100 / (10 (k - 1)) · (Σ odd (x - 1) + Σ even (k - x)),

which is Brooke's for k = 5. For k = 7 the means of the paper's table give 78.3. They are told to
one decimal, so that the true score is between 77.5 and 79.2, and the paper's 78.6 is in there.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from faults import Tr, plain

ITEMS = 10
PAPER, BROOKE = "sus-7", "sus-5"
"""The two questionnaires, by their names in files."""

Answers = Sequence[int | None]
"""The option that was chosen for each item, from 1; None for one that was left open."""


@dataclass(frozen=True)
class Questionnaire:
    """Ten items and what one can answer, from strong disagreement to strong agreement."""

    id: str
    title: str
    items: tuple[str, ...]
    options: tuple[str, ...]

    @property
    def middle(self) -> int:
        """The option in the middle, from 1."""
        return (len(self.options) + 1) // 2


def questionnaire(questionnaire_id: str, tr: Tr = plain) -> Questionnaire:
    """The questionnaire of this name in the words of ``tr``; the paper's for any other name."""
    return brooke_questionnaire(tr) if questionnaire_id == BROOKE else paper_questionnaire(tr)


def paper_questionnaire(tr: Tr = plain) -> Questionnaire:
    """The paper's: seven options, in its words."""
    items = (
        tr("I think that I would like to use this interface frequently"),
        tr("I found the interface unnecessarily complex"),
        tr("I thought the interface was easy-to-use"),
        tr("I needed technical support to use this interface"),
        tr("I found the functions in this interface well integrated"),
        tr("There was too much inconsistency in this interface"),
        tr("Most people can learn to use this interface very quickly"),
        tr("The interface is very difficult/awkward to use"),
        tr("I felt very confident using the interface"),
        tr("I learned a lot of things before I could use the interface"),
    )
    options = (
        tr("Strongly disagree"),
        tr("Disagree"),
        tr("Rather disagree"),
        tr("Neither agree nor disagree"),
        tr("Rather agree"),
        tr("Agree"),
        tr("Strongly agree"),
    )
    return Questionnaire(PAPER, tr("As in the paper, with 7 options"), items, options)


def brooke_questionnaire(tr: Tr = plain) -> Questionnaire:
    """Brooke's: five options, in his words."""
    items = (
        tr("I think that I would like to use this system frequently"),
        tr("I found the system unnecessarily complex"),
        tr("I thought the system was easy to use"),
        tr(
            "I think that I would need the support of a technical person to be able to use this"
            " system"
        ),
        tr("I found the various functions in this system were well integrated"),
        tr("I thought there was too much inconsistency in this system"),
        tr("I would imagine that most people would learn to use this system very quickly"),
        tr("I found the system very cumbersome to use"),
        tr("I felt very confident using the system"),
        tr("I needed to learn a lot of things before I could get going with this system"),
    )
    options = (
        tr("Strongly disagree"),
        tr("Disagree"),
        tr("Neither agree nor disagree"),
        tr("Agree"),
        tr("Strongly agree"),
    )
    return Questionnaire(BROOKE, tr("As Brooke made it, with 5 options"), items, options)


def sus_score(answers: Answers, options: int) -> float:
    """The score of one person, 0 to 100.

    An item left open counts as the option in the middle, as Brooke tells people to mark it.
    Raises ValueError where there are not ten answers, or one is not an option, or all are open.
    """
    if len(answers) != ITEMS or all(answer is None for answer in answers):
        raise ValueError(f"a score needs {ITEMS} items of which one at least is answered")
    middle = (options + 1) / 2
    filled = [middle if answer is None else answer for answer in answers]
    if any(not 1 <= answer <= options for answer in filled):
        raise ValueError(f"an answer is 1 to {options}, not {list(answers)}")
    return score_of_means(filled, options)


def score_of_means(means: Sequence[float], options: int) -> float:
    """The score, 0 to 100, of the mean answers to ten items: the mean score of the people."""
    in_favour, against = means[0::2], means[1::2]
    worth = sum(mean - 1 for mean in in_favour) + sum(options - mean for mean in against)
    return 100 * worth / (ITEMS * (options - 1))


# In which order a person meets the conditions of a study: a balanced Latin square.
#
# Source: E. J. Williams, "Experimental designs balanced for the estimation of residual effects of
# treatments", Australian Journal of Scientific Research A 2 (1949) 149-168. Each condition is as
# often at each place, and follows each other one as often. An odd number of conditions needs two
# squares, of which the second is the mirror of the first.


def latin_square(count: int) -> list[list[int]]:
    """The rows of the square for so many conditions, which are numbered from 0."""
    first = [0]
    for step in range(1, count):
        first.append((first[-1] + (step if step % 2 else -step)) % count)
    square = [[(number + row) % count for number in first] for row in range(count)]
    return square + [row[::-1] for row in square] if count % 2 and count > 1 else square


def conditions_for(participant: int, conditions: Sequence[str]) -> list[str]:
    """The conditions in the order for a participant, who are numbered from 1."""
    if not conditions:
        return []
    square = latin_square(len(conditions))
    return [conditions[number] for number in square[(participant - 1) % len(square)]]


def participant_number(code: str) -> int | None:
    """The number in a participant's code, as 7 in P07; None where there is none."""
    found = re.search(r"(\d{1,9})\D*$", code)
    number = int(found.group(1)) if found else 0
    return number or None


def next_code(codes: Sequence[str]) -> str:
    """A code for the next participant, P01 for the first."""
    last = max((participant_number(code) or 0 for code in codes), default=0)
    return f"P{last + 1:02d}"
