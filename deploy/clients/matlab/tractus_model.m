function forces = tractus_model(file, motion, parameters)
% TRACTUS_MODEL  Forces of a model that "tractus fmu" exported, in Octave or MATLAB on Linux.
%
%   model = tractus_model(FILE)
%     What the model has: a struct array with name, causality (input, output, parameter), unit, start, description, reference.
%
%   forces = tractus_model(FILE, motion)
%     A struct with a column for each output, as fz_N and tz_Nm, a row for each moment of the motion. motion is a struct of columns: t_s and
%     inputs, as x_m. Where v_m_s, a_m_s2 or omega_rad_s is missing, it is the difference quotient (gradient) of x_m, v_m_s or theta_rad,
%     and of a palpation model vx_m_s that of px_m, ax_m_s2 that of vx_m_s, and so on; other inputs keep their start value.
%
%   forces = tractus_model(FILE, motion, {NAME, VALUE; ...})
%     The same with other values of parameters.
%
%   motion.t_s = (0:0.001:2)'; motion.x_m = 0.01 * (1 - cos(2 * pi * motion.t_s));
%   forces = tractus_model('bone.fmu', motion, {'layers[1].stiffness_N_per_m', 900});
%   plot(motion.x_m, forces.fz_N)
%
% The first call builds tractus_fmu.c beside this file (mkoctfile or mex; a C compiler is needed).
  if exist(file, 'file') ~= 2
    error('tractus:input', '%s: no such file', file);
  end
  folder = tempname();
  mkdir(folder);
  removed = onCleanup(@() remove_folder(folder)); %#ok<NASGU>
  unzip(file, folder);
  [variables, guid] = read_description(fullfile(folder, 'modelDescription.xml'));
  if nargin < 2
    forces = variables;
    return
  end
  if nargin < 3
    parameters = cell(0, 2);
  end
  build_once();
  inputs = variables(strcmp({variables.causality}, 'input'));
  outputs = variables(strcmp({variables.causality}, 'output'));
  [times, table] = table_of(motion, inputs);
  [changed, values] = changes_of(parameters, variables(strcmp({variables.causality}, 'parameter')));
  library = fullfile(folder, 'binaries', 'linux64', 'tractus_model.so');
  found = tractus_fmu(library, ['file://' fullfile(folder, 'resources')], guid, times, [inputs.reference], table, ...
                      [outputs.reference], changed, values);
  for k = 1:numel(outputs)
    forces.(outputs(k).name) = found(:, k);
  end
end

function remove_folder(folder)
  if exist('OCTAVE_VERSION', 'builtin')
    confirm_recursive_rmdir(false, 'local');
  end
  rmdir(folder, 's');
end

function build_once()
  if exist('tractus_fmu', 'file') == 3
    return
  end
  here = fileparts(mfilename('fullpath'));
  source = fullfile(here, 'tractus_fmu.c');
  if exist('OCTAVE_VERSION', 'builtin')
    [status, said] = system(sprintf('cd "%s" && mkoctfile --mex "%s" -ldl 2>&1', here, source));
    if status ~= 0
      error('tractus:build', 'tractus_fmu.c: mkoctfile failed (package liboctave-dev): %s', said);
    end
    rehash();
  else
    mex('-outdir', here, source, '-ldl');
  end
end

% Of the variables, in the order of the file; the texts are those of "tractus fmu", one element a line.
function [variables, guid] = read_description(path)
  text = fileread(path);
  guid = attribute(text, 'guid', '');
  lines = regexp(text, '<ScalarVariable[^\n]*', 'match');
  variables = struct('name', {}, 'causality', {}, 'unit', {}, 'start', {}, 'description', {}, 'reference', {});
  for k = 1:numel(lines)
    line = lines{k};
    variables(k) = struct('name', attribute(line, 'name', ''), 'causality', attribute(line, 'causality', ''), ...
                          'unit', attribute(line, 'unit', '1'), 'start', str2double(attribute(line, 'start', 'NaN')), ...
                          'description', attribute(line, 'description', ''), ...
                          'reference', str2double(attribute(line, 'valueReference', 'NaN')));
  end
end

function value = attribute(text, name, missing)
  found = regexp(text, ['\s' name '="([^"]*)"'], 'tokens', 'once');
  if isempty(found)
    value = missing;
    return
  end
  value = found{1};
  for pair = {'&lt;', '<'; '&gt;', '>'; '&quot;', '"'; '&amp;', '&'}'
    value = strrep(value, pair{1}, pair{2});
  end
end

function [times, table] = table_of(motion, inputs)
  if ~isstruct(motion) || ~isfield(motion, 't_s')
    error('tractus:input', 'motion: a struct with the column t_s is expected');
  end
  times = double(motion.t_s(:));
  for field = fieldnames(motion)'
    if ~any(strcmp(field{1}, [{inputs.name}, {'t_s'}]))
      error('tractus:input', 'motion.%s: the model has no such input; it has t_s, %s', field{1}, strjoin({inputs.name}, ', '));
    end
    if numel(motion.(field{1})) ~= numel(times)
      error('tractus:input', 'motion.%s: %d rows where t_s has %d', field{1}, numel(motion.(field{1})), numel(times));
    end
  end
  motion = with_rates(motion, times);
  table = repmat([inputs.start], numel(times), 1);
  for k = 1:numel(inputs)
    if isfield(motion, inputs(k).name)
      table(:, k) = motion.(inputs(k).name);
    end
  end
end

function motion = with_rates(motion, times)
  pairs = {'x_m', 'v_m_s'; 'v_m_s', 'a_m_s2'; 'theta_rad', 'omega_rad_s'};
  for axis = 'xyz'
    pairs = [pairs; {['p' axis '_m'], ['v' axis '_m_s']; ['v' axis '_m_s'], ['a' axis '_m_s2']}]; %#ok<AGROW>
  end
  for pair = pairs'
    if isfield(motion, pair{1}) && ~isfield(motion, pair{2}) && numel(times) > 1
      motion.(pair{2}) = gradient(double(motion.(pair{1})(:)), times);
    end
  end
end

function [references, values] = changes_of(changes, parameters)
  references = zeros(1, 0);
  values = zeros(1, 0);
  for k = 1:size(changes, 1)
    which = find(strcmp({parameters.name}, changes{k, 1}));
    if isempty(which)
      error('tractus:input', '%s: the model has no such parameter; tractus_model(FILE) lists them', changes{k, 1});
    end
    references(k) = parameters(which).reference;
    values(k) = changes{k, 2};
  end
end
