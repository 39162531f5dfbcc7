"""The room of the lessons: exercises that answer, editions of the notebooks, marks.

`check` stands below each exercise. `editions` makes the notebooks of a student and of a teacher
from the one that is kept; `marking` reads a class's answers into one table.
"""

from .answer_tables import Exercise, exercise, exercises
from .checking import WrongAnswer, check
from .replies import Verdict

__all__ = ["Exercise", "Verdict", "WrongAnswer", "check", "exercise", "exercises"]
