"""Types of the arrays that everything here takes and gives."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Ints = NDArray[np.int64]
Marks = NDArray[np.bool_]
