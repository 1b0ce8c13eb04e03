// Generated in a LIGGGHTS build and not installed by Debian. Names the rolling models that we instantiate.
#include "rolling_model_cdt.h"
#include "rolling_model_epsd2.h"
