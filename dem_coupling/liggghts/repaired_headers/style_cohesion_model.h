// Generated in a LIGGGHTS build and not installed by Debian. Names the cohesion models that we instantiate.
#include "cohesion_model_sjkr.h"
#include "dem_coupling/liggghts/cohesion_model_charge.h"
#include "dem_coupling/liggghts/cohesion_model_charge_sjkr.h"
