from .findings import Findings as Findings
from .findings import gather as gather
from .html import page as page
from .study import Study as Study
from .terminal import show as show
