// Generated in a LIGGGHTS build and not installed by Debian. Names the tangential models that we instantiate.
#include "tangential_model_history.h"
#include "tangential_model_no_history.h"
