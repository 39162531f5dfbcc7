"""Cases as data: files and tables that become trains, decks and tracks, and the command."""

from .axletrains import read_train, train, train_list
from .cars import planar_car, sprung_mass, two_bogie_car
from .definition import Case, case
from .objects import box, car_parameters, deck, deck_from_table, varied_car, vehicle
from .opening import open_study
from .shelf import data_root
from .simplebridge import SimpleBridge
from .summary import summarize
from .sweeping import speed_envelope, sweep
from .trackfiles import track_record

__all__ = [
    "Case", "SimpleBridge", "box", "car_parameters", "case", "data_root", "deck", "deck_from_table",
    "open_study", "planar_car", "read_train", "speed_envelope", "sprung_mass", "summarize", "sweep",
    "track_record", "train", "train_list", "two_bogie_car", "varied_car", "vehicle",
]  # fmt: skip
