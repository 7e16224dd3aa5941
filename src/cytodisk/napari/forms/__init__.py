"""Forms for the parameters of commands: an editor a parameter, from the models that the command line has."""
