// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/fieldErrorTable.H"

#include "output/postProcessingFile.H"
#include "settings/checkedDictionary.H"

#include "Pstream.H"

namespace him {

fieldErrorTable::fieldErrorTable(const Foam::Time& runTime, const FieldErrorSettings& errorSettings,
                                 const FieldSettings& settings, PoissonMesh* mesh, const Box& demBox,
                                 const std::array<bool, 3>& periodic, MPI_Comm communicator)
    : runTime_(runTime),
      monitor_(errorSettings,
               errorSettings.active
                   ? FieldReference::find(settings, mesh, demBox, periodic, communicator, whyNoReference_)
                   : nullptr,
               settings.externalField, communicator),
      method_(settings.method),
      accuracy_(settings.accuracy),
      start_(Clock::now())
{
    if (!errorSettings.active) {
        return;
    }
    if (monitor_.reference().empty()) {
        Foam::Info << "Field error: n/a, there is no exact reference for " << settings.method.c_str()
                   << " here: " << whyNoReference_.c_str() << Foam::endl;
        return;
    }
    Foam::Info << "Field error: measured against " << monitor_.reference().c_str() << Foam::endl;
    if (Foam::Pstream::master()) {
        openFile();
    }
}

void fieldErrorTable::openFile()
{
    file_ = openPostProcessing(runTime_, "fieldError", "fieldError.dat", 6);
    file_ << "# Error of the field at a sample of the particles, against " << monitor_.reference() << ".\n"
          << "# rms and largest are relative to referenceRms [V/m]; sample: particles; seconds: of the measurement.\n"
          << "# Time sample rms largest referenceRms seconds" << std::endl;
}

void fieldErrorTable::update(const CoupledStep& step)
{
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    if (monitor_.due(updates_++, seconds)) {
        report(monitor_.measure(step.particles(), step.field().field));
    }
}

void fieldErrorTable::report(const FieldError& error)
{
    if (!error.failure.empty()) {
        Foam::Info << "Field error: not measured at " << runTime_.timeName() << " s, " << error.failure.c_str()
                   << Foam::endl;
        return;
    }
    Foam::Info << "Field error: rms " << shown(error.rms, 3).c_str() << ", largest " << shown(error.largest, 3).c_str()
               << " of the rms field, " << error.sample << " particles, " << shown(error.seconds, 2).c_str() << " s"
               << Foam::endl;
    if (accuracy_ > 0 && error.rms > accuracy_) {
        Foam::Info << "WARNING: constant/electrostaticProperties asks for accuracy " << accuracy_
                   << " and the field has " << shown(error.rms, 3).c_str() << ". "
                   << (method_ == "p3m" ? "Ask for a smaller accuracy, raise p3mCoeffs.cloudCells, or refine the mesh."
                                        : "Set fieldMethod to p3m, or leave it out, so that accuracy chooses.")
                   << Foam::endl;
    }
    if (file_.is_open()) {
        file_ << runTime_.value() << ' ' << error.sample << ' ' << error.rms << ' ' << error.largest << ' '
              << error.referenceRms << ' ' << error.seconds << std::endl;
    }
}

}  // namespace him
